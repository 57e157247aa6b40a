#include "shaders/lists/validation/long_loop.glsl"
#include "shaders/shared/linear_id.glsl"

void main() {
  uint id = linearId();
  if (id < COUNT) counts[id] = iterations(id);
}
