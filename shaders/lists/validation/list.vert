// Pushes a vertex: point `gl_VertexID`. Nothing is drawn.
#include "shaders/lists/validation/list.glsl"

void main() {
  push(uint(gl_VertexID));
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}
