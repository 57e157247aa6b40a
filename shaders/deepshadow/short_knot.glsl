// How knots of smoke are stored (shaders/shared/deepshadow.h): as floats, or short, with depths in steps of one size from
// where a texel's smoke starts to its last knot, and square roots of optical depths, so that all of them are as exact in
// what passes.
#include "shaders/deepshadow/smoke_knot.glsl"

// By how much shortTau() changes the transmittance at most: its step is widest, times exp(-tau), where tau is 1/2.
const float SHORT_TAU_ERROR = 0.43 * sqrt(SHADOW_SHORT_TAU) / SHADOW_SHORT_TAUS;

uint smokeKnotsInUnit(bool isShort) {
#ifdef COLOURED_SMOKE
  return isShort ? 2u : 1u;
#else
  return isShort ? 4u : 2u;
#endif
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

// Their depths are in steps.
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
#endif
