#include "shaders/lists/validation/leave_loop.glsl"
#include "shaders/shared/linear_id.glsl"

void main() {
  uint id = linearId();
  if (id < COUNT) sums[id] = walk(id);
}
