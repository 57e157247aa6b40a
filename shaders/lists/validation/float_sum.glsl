// Adds a float to a sum by compare-and-swap on its bits. The numbers are multiples of 1/256 whose sums floats hold
// exactly, in whatever order. WITHOUT_ATOMIC, the control: a plain load and store.
#include "shaders/shared/hash.glsl"

layout(std430, binding = 0) coherent buffer Sums {
  uint sums[];
};
layout(std430, binding = 1) coherent buffer Outcome {
  uint gaveUp;
  uint maxTries;
};

const uint TRY_LIMIT = 16384u;

void addToSum(uint id) {
  float number = float(1u + hash(id + SEED) % 4u) / 256.0;
  uint address = hash(id + SEED + 1u) % ADDRESSES;
#if defined(WITHOUT_ATOMIC) || defined(MUTANT_NO_ATOMIC)
  sums[address] = floatBitsToUint(uintBitsToFloat(sums[address]) + number);
#else
  uint expected = sums[address];
  bool done = false;
  uint tries = 0u;
  while (!done && tries < TRY_LIMIT) {
    uint sum = floatBitsToUint(uintBitsToFloat(expected) + number);
    uint before = atomicCompSwap(sums[address], expected, sum);
    if (before == expected) done = true;
    expected = before;
    ++tries;
  }
  if (!done) atomicAdd(gaveUp, 1u);
  atomicMax(maxTries, tries);
#endif
}
