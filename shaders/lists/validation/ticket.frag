// A ticket for every fragment of a square of SIDE pixels.
#include "shaders/lists/validation/ticket.glsl"

flat in uint layer;

void main() {
  drawTicket((layer * SIDE + uint(gl_FragCoord.y)) * SIDE + uint(gl_FragCoord.x));
}
