// A walk with everything that leaves a loop or an iteration early: break, continue, return, nested.
#include "shaders/shared/hash.glsl"

layout(std430, binding = 0) readonly buffer Links {
  uint links[];
};
layout(std430, binding = 1) writeonly buffer Sums {
  uint sums[];
};

uint walk(uint id) {
  uint sum = id;
  uint node = 1u + hash(id + SEED) % NODES;
  for (uint step = 0u; step < 64u; ++step) {
    if (node == 0u) break;
    uint word = hash(node + id);
    node = links[node];
#ifndef MUTANT_NO_CONTINUE
    if ((word & 3u) == 0u) continue;
#endif
    for (uint bit = 0u; bit < 8u; ++bit) {
      if (((word >> bit) & 1u) == 0u) continue;
      if (bit > (word >> 8) % 8u) break;
      sum += hash(word + bit);
      if (sum % 257u == 0u) return sum;
    }
    sum = sum * 31u + word;
  }
  return ~sum;
}
