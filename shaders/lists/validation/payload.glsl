// Nodes of QUADS x 16 bytes: a `next`, the item, words that are hashed from it, and their sum in the last word.
#include "shaders/shared/hash.glsl"

struct Node {
  uvec4 quads[QUADS];
};

layout(std430, binding = 0) coherent buffer Heads {
  uint heads[];
};
layout(std430, binding = 1) coherent buffer Nodes {
  Node nodes[];
};
layout(std430, binding = 2) coherent buffer Outcome {
  uint demand;
  uint walked;  // nodes reached by the second pass
  uint torn;    // of these, where item, words and sum do not belong together
  uint boundHits;
};

// The node of `item`, complete but for its `next`.
Node nodeOf(uint item) {
  Node node;
  uint sum = item;
  for (uint q = 0u; q < uint(QUADS); ++q)
    for (uint i = 0u; i < 4u; ++i) {
      uint word = hash(item * 16u + q * 4u + i);
      if (q == 0u && i == 0u) word = 0u;
      if (q == 0u && i == 1u) word = item;
      if (q == uint(QUADS) - 1u && i == 3u) word = sum;
      node.quads[q][i] = word;
      sum += word;
    }
  return node;
}
