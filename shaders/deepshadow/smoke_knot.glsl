// A knot of the smoke's part of a texel's function, and how it is stored (shaders/shared/deepshadow.h): as floats, or short,
// with its depth in steps of one size from where the texel's smoke starts to its last knot, and the square root of its optical
// depth, so that all of them are as exact in what passes.
#include "shaders/shared/deepshadow.h"
#include "shaders/volumes/extinction.glsl"

struct SmokeKnot {
  float depth;
  Extinction tau;  // optical depth from the light to here
};

// By how much shortTau() changes the transmittance at most: its step is widest, times exp(-tau), where tau is 1/2.
const float SHORT_TAU_ERROR = 0.43 * sqrt(SHADOW_SHORT_TAU) / SHADOW_SHORT_TAUS;

// A unit of the pool holds 1 << knotsShift() knots.
uint knotsShift(bool isShort) {
#ifdef COLOURED_SMOKE
  return isShort ? 1u : 0u;
#else
  return isShort ? 2u : 1u;
#endif
}

// Units that so many knots take.
uint smokeUnits(uint knots, bool isShort) {
  uint shift = knotsShift(isShort);
  return (knots + (1u << shift) - 1u) >> shift;
}

// Depth before which a texel has no short knots; `last`: of the last one.
float shortStart(uint count, float last) {
  return last * (float(count >> SHADOW_START_BIT & SHADOW_START_MASK) / SHADOW_STARTS);
}

// Steps of depth per unit of depth.
float shortSteps(float start, float last) {
  return SHADOW_SHORT_DEPTHS / (last - start);
}

// The largest first word of a short knot at or before a depth, in steps.
uint shortKey(float depth) {
  return uint(depth) << SHADOW_TAU_BITS | SHADOW_TAU_MASK;
}

uint shortTau(float tau) {
  return uint(sqrt(tau / SHADOW_SHORT_TAU) * SHADOW_SHORT_TAUS + 0.5);
}

float tauOfShort(uint tau) {
  float root = float(tau & SHADOW_TAU_MASK) / SHADOW_SHORT_TAUS;
  return root * root * SHADOW_SHORT_TAU;
}

// Of short ones, depths are in steps. knotsAround(): the knots of a unit and the first of the next one that a key is between.
#ifdef COLOURED_SMOKE
uvec2 shortWords(uint depth, vec3 tau) {
  return uvec2(depth << SHADOW_TAU_BITS | shortTau(tau.r), shortTau(tau.g) << SHADOW_TAU_BITS | shortTau(tau.b));
}
SmokeKnot shortKnot(uvec2 words) {
  return SmokeKnot(float(words.x >> SHADOW_TAU_BITS),
                   vec3(tauOfShort(words.x), tauOfShort(words.y >> SHADOW_TAU_BITS), tauOfShort(words.y)));
}
SmokeKnot longKnot(uvec4 words) {
  return SmokeKnot(uintBitsToFloat(words.x), uintBitsToFloat(words.yzw));
}

void knotsAround(uvec4 unit, uvec4 next, uint key, bool isShort, out SmokeKnot before, out SmokeKnot after) {
  bool second = isShort && unit.z <= key;
  before = isShort ? shortKnot(second ? unit.zw : unit.xy) : longKnot(unit);
  after = isShort ? shortKnot(second ? next.xy : unit.zw) : longKnot(next);
}

// What stands for the unit behind a texel's last one: the same again.
uvec4 unitBehind(uvec4 last, bool isShort) {
  return isShort ? last.zwzw : last;
}
#else
uint shortWord(uint depth, float tau) {
  return depth << SHADOW_TAU_BITS | shortTau(tau);
}
SmokeKnot shortKnot(uint word) {
  return SmokeKnot(float(word >> SHADOW_TAU_BITS), tauOfShort(word));
}
SmokeKnot longKnot(uvec2 words) {
  return SmokeKnot(uintBitsToFloat(words.x), uintBitsToFloat(words.y));
}

void knotsAround(uvec4 unit, uvec4 next, uint key, bool isShort, out SmokeKnot before, out SmokeKnot after) {
  if (isShort) {
    uvec4 behind = uvec4(unit.yzw, next.x);
    uvec2 words = uvec2(unit.x, behind.x);
    for (int i = 1; i < 4; ++i)
      if (unit[i] <= key) words = uvec2(unit[i], behind[i]);
    before = shortKnot(words.x);
    after = shortKnot(words.y);
  } else {
    bool second = unit.z <= key;
    before = longKnot(second ? unit.zw : unit.xy);
    after = longKnot(second ? next.xy : unit.zw);
  }
}

uvec4 unitBehind(uvec4 last, bool isShort) {
  return isShort ? last.wwww : last.zwzw;
}
#endif
