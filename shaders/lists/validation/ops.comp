#include "shaders/lists/validation/ops.glsl"

layout(local_size_x = 64) in;

void main() {
  uint id = gl_LocalInvocationIndex;
#ifdef IN_SHARED
  for (uint slot = id; slot < SLOTS; slot += INVOCATIONS) memory[slot] = words[slot];
  barrier();
#endif
  runOperations(id);
#ifdef IN_SHARED
  barrier();
  for (uint slot = id; slot < SLOTS; slot += INVOCATIONS) words[slot] = memory[slot];
#endif
}
