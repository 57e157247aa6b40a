// Item after item takes a node, fills it and puts it into one of HEADS lists.
#include "shaders/lists/validation/payload.glsl"
#include "shaders/shared/linear_id.glsl"

void main() {
  uint item = linearId();
  if (item >= COUNT) return;
#if defined(WITHOUT_ATOMIC) || defined(MUTANT_NO_ATOMIC)
  uint node = demand + 1u;
  demand = node;
#else
  uint node = atomicAdd(demand, 1u) + 1u;
#endif
  nodes[node] = nodeOf(item);
  nodes[node].quads[0].x = atomicExchange(heads[hash(item) % HEADS], node);
}
