#include "shaders/lists/validation/ops.glsl"

void main() {
  runOperations(uint(gl_VertexID));
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}
