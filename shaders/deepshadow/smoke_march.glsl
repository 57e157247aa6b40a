// A march through the smoke before a light that gives as few knots as keep the transmittance of each channel within an error
// bound (Lokovic and Veach 2000, section 3.2, here on the optical depth, so that homogeneous smoke takes two).
#include "shaders/deepshadow/smoke_knot.glsl"
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
// ends where a channel has none left, where the smoke ends, or where it is dark.
struct SmokeMarch {
  float depth;
  Extinction tau;    // at depth
  SmokeKnot segment;
  Extinction slopeMin;
  Extinction slopeMax;
  bool open;             // in a segment
};

SmokeMarch startOfMarch(SmokeRay ray) {
  const Extinction NONE = Extinction(0.0);
  return SmokeMarch(ray.media.rangeOfAll.x, NONE, SmokeKnot(0.0, NONE), NONE, Extinction(3e38), false);
}

bool isInside(SmokeMarch march, SmokeRay ray) {
  return march.depth < ray.end && minComponent(march.tau) < DARK_TAU;
}

bool goesOn(SmokeMarch march, SmokeRay ray) {
  return march.open || isInside(march, ray);
}

// Marches one step. True when that fixed a knot.
bool marchStep(SmokeRay ray, inout SmokeMarch march, out SmokeKnot knot) {
  bool inside = isInside(march, ray);
  float to = inside ? stepEnd(ray.media, march.depth, ray.end) : march.depth;
  Extinction sigma = inside ? extinction(ray.media, 0.5 * (march.depth + to)) : Extinction(0.0);
  bool smoky = maxComponent(sigma) > 0.0;
  if (inside && !smoky) to = emptyEnd(ray.media, march.depth, to, ray.end);
  bool fixes = false;
  if (!march.open && smoky) {
    fixes = march.open = true;
    march.segment.depth = march.depth;
    march.slopeMin = Extinction(0.0);
    march.slopeMax = Extinction(3e38);
  }
  if (march.open) {
    Extinction nextTau = march.tau + sigma * ((to - march.depth) * ray.metresPerDepth);
    // tau may be off by -log(1 + x) to -log(1 - x), x = bound / T; these lie within, and need no logarithm.
    Extinction x = ray.bound * exp(min(nextTau, Extinction(64.0)));
    Extinction tauMin = nextTau - x / (1.0 + x);
    Extinction tauMax = nextTau + x;
    float run = to - march.segment.depth;
    Extinction newMin = max(march.slopeMin, (tauMin - march.segment.tau) / run);
    Extinction newMax = min(march.slopeMax, (tauMax - march.segment.tau) / run);
    march.open = smoky;
    if ((!march.open || maxComponent(newMin - newMax) > 0.0 || ray.bound == 0.0) && march.depth > march.segment.depth) {
      float range = march.depth - march.segment.depth;
      march.segment.tau += range * clamp((march.tau - march.segment.tau) / range, march.slopeMin, march.slopeMax);
      march.segment.depth = march.depth;
      fixes = true;
      newMin = max(Extinction(0.0), (tauMin - march.segment.tau) / (to - march.depth));
      newMax = (tauMax - march.segment.tau) / (to - march.depth);
    }
    if (march.open) {
      march.slopeMin = newMin;
      march.slopeMax = max(newMin, newMax);
      march.tau = nextTau;
    }
  }
  knot = march.segment;
  march.depth = to;
  return fixes;
}
