#include "shaders/lists/validation/ticket.glsl"

void main() {
  drawTicket(uint(gl_VertexID));
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}
