// Every invocation draws a ticket from one of ADDRESSES counters and notes that this ticket was drawn.
// WITHOUT_ATOMIC, the control: a plain load and store.
#include "shaders/shared/hash.glsl"

#ifdef MUTANT_NO_ATOMIC
#define WITHOUT_ATOMIC
#endif

layout(std430, binding = 0) coherent buffer Counters {
  uint counters[];
};
layout(std430, binding = 1) coherent buffer Drawn {
  uint drawn[];  // how often each ticket was drawn: CAPACITY for each counter
};
layout(std430, binding = 2) coherent buffer Outcome {
  uint strays;  // tickets beyond the capacity
};

void drawTicket(uint id) {
  uint address = ADDRESSES == COUNT ? id : hash(id + SEED) % ADDRESSES;
#ifdef WITHOUT_ATOMIC
  uint ticket = counters[address];
  counters[address] = ticket + 1u;
#else
  uint ticket = atomicAdd(counters[address], 1u);
#endif
  if (ticket < CAPACITY) atomicAdd(drawn[address * CAPACITY + ticket], 1u);
  else atomicAdd(strays, 1u);
}
