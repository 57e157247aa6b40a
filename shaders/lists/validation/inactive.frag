// Atomic operations where some lanes of a vector are not to take part: beside the triangle, after a return, after a
// discard, in a branch, in a loop.
#include "shaders/shared/hash.glsl"

flat in uint number;

layout(std430, binding = 0) coherent buffer Counts {
  uint counts[5];  // of all fragments; after the return; after the discard; in the branch; in the loop
};
layout(std430, binding = 1) coherent buffer Pixels {
  uint pixels[];  // fragments of each
};

void main() {
  uint pixel = uint(gl_FragCoord.y) * SIDE + uint(gl_FragCoord.x);
  uint word = hash(pixel + number * SIDE * SIDE + SEED);
  // A derivative, so that there are lanes beside the triangle.
  float slope = dFdx(gl_FragCoord.x * gl_FragCoord.x);
  atomicAdd(counts[0], 1u);
  atomicAdd(pixels[pixel], slope > -1e30 ? 1u : 0u);
  if (word % 5u == 0u) return;
  atomicAdd(counts[1], 1u);
#ifndef WITHOUT_DISCARD
  if (word % 5u == 1u) discard;
#endif
  atomicAdd(counts[2], 1u);
#ifndef MUTANT_NO_BRANCH
  if (word % 5u == 2u)
#endif
    atomicAdd(counts[3], 1u);
  for (uint i = 0u; i < (word >> 8) % 7u; ++i)
    atomicAdd(counts[4], 1u);
}
