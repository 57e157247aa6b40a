// Operations on words with awkward bits: pair `id` of the numbers a and b.
#include "shaders/shared/linear_id.glsl"

layout(std430, binding = 0) readonly buffer Pairs {
  uvec2 pairs[];
};
layout(std430, binding = 1) coherent buffer Unsigned {
  uint unsignedWords[];  // four a pair, a at first
};
layout(std430, binding = 2) coherent buffer Signed {
  int signedWords[];  // two a pair, a at first
};
layout(std430, binding = 3) coherent buffer Floats {
  float floats[];  // two a pair: stored, copied
};
layout(std430, binding = 4) writeonly buffer Returned {
  uint returned[];  // four a pair
};

void main() {
  uint id = linearId();
  if (id >= COUNT) return;
  uint a = pairs[id].x;
  uint b = pairs[id].y;
  returned[id * 4u] = atomicMin(unsignedWords[id * 4u], b);
  returned[id * 4u + 1u] = atomicMax(unsignedWords[id * 4u + 1u], b);
  returned[id * 4u + 2u] = atomicExchange(unsignedWords[id * 4u + 2u], b);
  returned[id * 4u + 3u] = atomicCompSwap(unsignedWords[id * 4u + 3u], a, b);
#ifdef MUTANT_UNSIGNED
  atomicMin(unsignedWords[id * 4u], uint(b >> 1));
#endif
  atomicMin(signedWords[id * 2u], int(b));
  atomicMax(signedWords[id * 2u + 1u], int(b));
  floats[id * 2u] = uintBitsToFloat(a);
  memoryBarrierBuffer();
  floats[id * 2u + 1u] = floats[id * 2u];
}
