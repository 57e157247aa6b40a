// Walks each list and holds every node against what its item says.
#include "shaders/lists/validation/payload.glsl"
#include "shaders/shared/linear_id.glsl"

void main() {
  uint list = linearId();
  if (list >= HEADS) return;
  uint current = heads[list];
  uint steps = 0u;
  while (current != 0u && steps < COUNT) {
    Node node = nodes[current];
    Node right = nodeOf(node.quads[0].y);
    bool equal = node.quads[0].y < COUNT && hash(node.quads[0].y) % HEADS == list;
    for (int q = 0; q < QUADS; ++q) {
      uvec4 mask = q == 0 ? uvec4(0u, ~0u, ~0u, ~0u) : uvec4(~0u);
      if (any(notEqual(node.quads[q] & mask, right.quads[q] & mask))) equal = false;
    }
    if (!equal) atomicAdd(torn, 1u);
    atomicAdd(walked, 1u);
    ++steps;
    current = node.quads[0].x;
  }
  if (current != 0u) atomicAdd(boundHits, 1u);
}
