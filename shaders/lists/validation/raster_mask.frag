// A MASK material: half of the pixels of a square of SIDE are cut out, before the push onto the pixel's list or
// (DISCARD_AFTER) behind it. What is cut depends on a derivative, so that the lanes beside a triangle take part.
#include "shaders/shared/hash.glsl"

layout(std430, binding = 0) coherent buffer Heads {
  uint heads[];
};
layout(std430, binding = 1) coherent buffer Nodes {
  uint nodes[];  // the next of each; [0] counts them
};

void push(uint pixel) {
  uint node = atomicAdd(nodes[0], 1u) + 1u;
  if (node < uint(nodes.length())) nodes[node] = atomicExchange(heads[pixel], node);
}

void main() {
  uint pixel = uint(gl_FragCoord.y) * SIDE + uint(gl_FragCoord.x);
  float slope = dFdx(gl_FragCoord.x * 4.0);  // 4 in every lane
  float alpha = float(hash(pixel) & 1u) * slope / 4.0;
#ifdef DISCARD_AFTER
  push(pixel);
  if (alpha < 0.5) discard;
#else
#ifndef MUTANT_NO_DISCARD
  if (alpha < 0.5) discard;
#endif
  push(pixel);
#endif
}
