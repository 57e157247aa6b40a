// Pushes the items 0 … COUNT - 1.
#include "shaders/lists/validation/list.glsl"
#include "shaders/shared/linear_id.glsl"

void main() {
  uint item = linearId();
  if (item < COUNT) push(item);
}
