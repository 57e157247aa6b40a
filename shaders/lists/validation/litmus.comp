// Workgroups that start one after the other are partners, whatever the order in which a driver starts them.
#include "shaders/lists/validation/litmus.glsl"

layout(local_size_x = 64) in;

shared uint groupTicket;

void main() {
  if (gl_LocalInvocationIndex == 0u) {
    gate();
    groupTicket = atomicAdd(ticket, 1u);
  }
  barrier();
  litmus(groupTicket & 1u, (groupTicket >> 1) * 64u + gl_LocalInvocationIndex);
}
