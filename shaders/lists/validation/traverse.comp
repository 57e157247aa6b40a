#include "shaders/lists/validation/traverse.glsl"
#include "shaders/shared/linear_id.glsl"

void main() {
  if (linearId() < HEADS) traverse(linearId());
}
