// Every invocation stores one node into a hashed cell with a hashed depth: contention across lanes and workgroups. Nodes
// are numbered through a permutation, so that their order changes with the seed of it.
// PAYLOAD: as many words as it has; the first is the node's number, the others follow from it.
// Negative controls: WITHOUT_LOCK inserts by plain loads and stores; ELSEWHERE_WHEN_SCATTERED moves a node between the
// two draws of `count`.
#include "shaders/shared/bindings.h"
#if PAYLOAD == 1
#define LIST_PAYLOAD uint
#elif PAYLOAD == 3
struct Payload {
  uint number;
  uint twice;
  uint inverse;
};
#define LIST_PAYLOAD Payload
#endif
#include "shaders/lists/insert.glsl"
#include "shaders/shared/hash.glsl"
#include "shaders/shared/linear_id.glsl"

layout(std140, binding = UNIFORM_PASS) uniform Pass {
  uvec4 params;  // nodes, cells, distinct depths, seed
  uvec4 more;    // x, y: node = (x * invocation + y) mod nodes; z: first invocation; w: invocations
};

void main() {
  if (linearId() >= more.w) return;
  uint number = (more.x * (linearId() + more.z) + more.y) % params.x;
  uint cell = hash(number + params.w) % params.y;
#if defined(ELSEWHERE_WHEN_SCATTERED) && LIST_PASS == LIST_PASS_SCATTER
  if (number == 1234u) cell = (cell + 1u) % params.y;
#endif
  float depth = float(hash(number * 3u + params.w) % params.z) - 2.0;
#if defined(WITHOUT_LOCK) && LIST_PASS == LIST_PASS_SPINLOCK
  uint node = listAllocate();
  if (node == 0u) return;
  setLinkKey(node, listKey(depth, number));
  setLinkNext(node, listHeads[cell]);
  listHeads[cell] = node;
#elif PAYLOAD == 1
  listStore(cell, depth, number, number);
#elif PAYLOAD == 3
  listStore(cell, depth, number, Payload(number, 2u * number, ~number));
#else
  listStore(cell, depth, number);
#endif
}
