// Every invocation inserts one node into a hashed cell with a hashed depth: contention across lanes and workgroups.
// WITHOUT_LOCK is the negative control: the same insertion by plain loads and stores.
#include "shaders/lists/linked_insert.glsl"
#include "shaders/shared/linear_id.glsl"

layout(std140, binding = UNIFORM_PASS) uniform Pass {
  uvec4 params;  // nodes, cells, distinct depths, seed
};
layout(std430, binding = STORAGE_OLD_PAYLOADS) writeonly buffer Payloads {
  uint payloads[];
};

uint hash(uint x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  return x ^ x >> 16;
}

void main() {
  uint number = linearId();
  if (number >= params.x) return;
  uint cell = hash(number + params.w) % params.y;
  float depth = float(hash(number * 3u + params.w) % params.z);
  uint node = listAllocate();
  if (node == 0u) return;
  payloads[node] = number;
#ifdef WITHOUT_LOCK
  listLinks[node].depth = depth;
  listLinks[node].id = number;
  uint head = listHeads[cell];
  listLinks[node].next = head;
  listHeads[cell] = node;
#else
  listInsert(cell, node, depth, number, 0u);
#endif
}
