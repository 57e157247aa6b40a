// Vertices of points that nobody sees.
#include "shaders/lists/validation/litmus.glsl"

flat out uint layer;

void main() {
  litmus(0u, uint(gl_VertexID));
  layer = 0u;
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}
