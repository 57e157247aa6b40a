// A march through the smoke before a light that gives as few knots (depth, optical depth) as keep the transmittance within
// an error bound (Lokovic and Veach 2000, section 3.2, here on the optical depth, so that homogeneous smoke takes two).
#include "shaders/volumes/media.glsl"

const float DARK_TAU = 16.0;     // exp(-16) is nothing
const float MAX_STEPS = 16384.0;

// What is marched along.
struct SmokeRay {
  MediaRay media;
  float end;             // depth
  float metresPerDepth;
  float bound;           // of the error; 0: every step is a knot
};

// How far it has come. A segment starts at the last knot; any slope in [slopeMin, slopeMax] stays within the bound. It
// ends where none is left, where the smoke ends, or where it is dark.
struct SmokeMarch {
  float depth;
  float tau;             // at depth
  float segmentDepth;    // of the last knot
  float segmentTau;
  float slopeMin;
  float slopeMax;
  bool open;             // in a segment
};

SmokeMarch startOfMarch(SmokeRay ray) {
  return SmokeMarch(ray.media.rangeOfAll.x, 0.0, 0.0, 0.0, 0.0, 3e38, false);
}

bool goesOn(SmokeMarch march, SmokeRay ray) {
  return march.open || (march.depth < ray.end && march.tau < DARK_TAU);
}

// Marches one step. True when that fixed a knot.
bool marchStep(SmokeRay ray, inout SmokeMarch march, out vec2 knot) {
  bool inside = march.depth < ray.end && march.tau < DARK_TAU;
  float to = inside ? stepEnd(ray.media, march.depth, ray.end) : march.depth;
  float sigma = inside ? extinction(ray.media, 0.5 * (march.depth + to)) : 0.0;
  if (inside && sigma == 0.0) to = emptyEnd(ray.media, march.depth, to, ray.end);
  bool fixes = false;
  if (!march.open && sigma > 0.0) {
    fixes = march.open = true;
    march.segmentDepth = march.depth;
    march.slopeMin = 0.0;
    march.slopeMax = 3e38;
  }
  if (march.open) {
    float nextTau = march.tau + sigma * (to - march.depth) * ray.metresPerDepth;
    // tau may be off by -log(1 + x) to -log(1 - x), x = bound / T; these lie within, and need no logarithm.
    float x = ray.bound * exp(nextTau);
    float tauMin = nextTau - 2.0 * x / (2.0 + x);
    float tauMax = x < 1.0 ? nextTau + x + 0.5 * x * x : 3e38;
    float run = to - march.segmentDepth;
    float newMin = max(march.slopeMin, (tauMin - march.segmentTau) / run);
    float newMax = min(march.slopeMax, (tauMax - march.segmentTau) / run);
    march.open = sigma > 0.0;
    if ((!march.open || newMin > newMax || ray.bound == 0.0) && march.depth > march.segmentDepth) {
      float range = march.depth - march.segmentDepth;
      march.segmentTau += range * clamp((march.tau - march.segmentTau) / range, march.slopeMin, march.slopeMax);
      march.segmentDepth = march.depth;
      fixes = true;
      newMin = max(0.0, (tauMin - march.segmentTau) / (to - march.depth));
      newMax = (tauMax - march.segmentTau) / (to - march.depth);
    }
    if (march.open) {
      march.slopeMin = newMin;
      march.slopeMax = max(newMin, newMax);
      march.tau = nextTau;
    }
  }
  knot = vec2(march.segmentDepth, march.segmentTau);
  march.depth = to;
  return fixes;
}
