// Stores one node of each of NODES (a power of two) in a cell of CELLS, in an order that FACTOR (odd) and OFFSET shuffle; few
// depths, so that most nodes of a cell are told apart by their number alone.
#define LIST_PAYLOAD uint
#include "shaders/lists/insert.glsl"
#include "shaders/shared/hash.glsl"
#include "shaders/shared/linear_id.glsl"

layout(std140, binding = UNIFORM_PASS) uniform Order {
  uvec4 order;  // x: factor, y: offset
};

void main() {
  if (linearId() >= NODES) return;
  uint number = (linearId() * order.x + order.y) % NODES;
#ifdef MUTANT_SAME_ID
  uint id = 0u;
#else
  uint id = number;
#endif
  listStore(hash(number + SEED) % CELLS, float(hash(number * 3u + SEED) % 5u), id, hash(number * 5u + SEED));
}
