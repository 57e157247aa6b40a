// COUNT invocations, each once in the section of LOCK_INDEX (an expression of `id`).
#include "shaders/lists/validation/lock.glsl"
#include "shaders/shared/linear_id.glsl"

void main() {
  uint id = linearId();
  if (gl_LocalInvocationIndex == 0u) gate();
  if (id < COUNT) lockOnce(LOCK_INDEX, id);
}
