#include "shaders/lists/validation/ticket.glsl"
#include "shaders/shared/linear_id.glsl"

void main() {
  if (linearId() < COUNT) drawTicket(linearId());
}
