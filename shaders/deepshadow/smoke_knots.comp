// Writes the knots of a face's texels of smoke, marched from the light to the farthest opaque depth that anything which
// reads them is before. Smoke comes in order of depth by itself: it needs no list. Its knots are kept while they are
// counted; what is more than a few is marched again. They are short knots where these are exact enough.
#include "shaders/deepshadow/knot_pool.glsl"
#include "shaders/deepshadow/smoke_knot.glsl"
#include "shaders/deepshadow/smoke_march.glsl"

const uint KEPT = 24u;
SmokeKnot kept[KEPT];
const float SHORT_SHARE = 0.1;  // of the error's bound, what short knots may take of it

// Of what is lit through this texel or its neighbours, that is in a square of two texels of smoke and in what filters reach
// beyond it; `enough` or more where that is as far as anybody wants to know.
float farthestOpaque(ivec2 texel, float enough) {
  const float REACH = 2.0;  // of the widest filter, in texels of surfaces
  vec2 whole = vec2(textureSize(opaqueDepth, 0));  // of all faces that stand in it
  ivec2 size = ivec2(whole.x);
  vec2 ratio = vec2(size) / vec2(view.size.xy);
  ivec2 first = max(ivec2((vec2(texel) - 0.5) * ratio - REACH), ivec2(0));
  ivec2 end = min(ivec2((vec2(texel) + 1.5) * ratio + REACH), size - 1);
  float farthest = 0.0;
  for (int y = first.y; y <= end.y && farthest < enough; y += 2) {
    for (int x = first.x; x <= end.x && farthest < enough; x += 2) {
      vec4 four = textureGather(opaqueDepth, vec2(x + 1, params.units.z + min(y, size.y - 2) + 1) / whole);
      farthest = max(farthest, max(max(four.x, four.y), max(four.z, four.w)));
    }
  }
  return farthest;
}

// What of the bound is left to short knots; 0 where it is too small for them.
float shortShare() {
  return params.march.y * SHORT_SHARE > SHORT_TAU_ERROR ? SHORT_SHARE : 0.0;
}

SmokeRay smokeRay(ivec2 texel) {
  vec2 plane = ((vec2(texel) + 0.5) / vec2(view.size.xy) * 2.0 - 1.0) * view.halfExtent.xy;
  bool orthographic = view.halfExtent.z != 0.0;
  vec3 originView = orthographic ? vec3(plane, 0.0) : vec3(0.0);
  vec3 perDepthView = orthographic ? vec3(0.0, 0.0, -1.0) : vec3(plane, -1.0);
  vec3 origin = (view.worldFromView * vec4(originView, 1.0)).xyz;
  vec3 perDepth = mat3(view.worldFromView) * perDepthView;
  SmokeRay ray;
  ray.media = mediaRay(origin, perDepth, vec2(0.0, NOTHING_OPAQUE), params.march.x);
  vec2 range = ray.media.rangeOfAll;
  ray.end = range.x < range.y ? min(range.y, farthestOpaque(texel, range.y)) : range.y;
  ray.metresPerDepth = length(perDepth);
  ray.bound = params.march.y * (1.0 - shortShare());
  float tooMany = range.x < ray.end ? stepsAtMost(ray.media) / MAX_STEPS : 0.0;
  if (tooMany > 1.0) {
    atomicAdd(counters.boundHit, 1u);
    for (int v = 0; v < VOLUME_COUNT; ++v) ray.media.stride[v] *= tooMany;
  }
  return ray;
}

// By how much the transmittance falls per unit of depth between two knots, at most.
float steepness(SmokeKnot before, SmokeKnot after) {
  Extinction rise = after.tau - before.tau;
  return after.depth > before.depth ? maxComponent(exp(-before.tau) * rise) / (after.depth - before.depth) : 0.0;
}

bool isShort = false;
float start = 0.0;  // of short knots
float steps = 0.0;  // likewise

void writeKnot(SmokeKnot knot) {
  uint depth = min(uint(max((knot.depth - start) * steps, 0.0) + 0.5), uint(SHADOW_SHORT_DEPTHS));
#ifdef COLOURED_SMOKE
  uvec2 both = shortWords(depth, knot.tau);
  writeWord(isShort ? both.x : floatBitsToUint(knot.depth));
  writeWord(isShort ? both.y : floatBitsToUint(knot.tau.r));
  if (!isShort) {
    writeWord(floatBitsToUint(knot.tau.g));
    writeWord(floatBitsToUint(knot.tau.b));
  }
#else
  writeWord(isShort ? shortWord(depth, knot.tau) : floatBitsToUint(knot.depth));
  if (!isShort) writeWord(floatBitsToUint(knot.tau));
#endif
}

void main() {
  if (!isWritten()) return;
  SmokeRay ray = smokeRay(texelOfCell());
  SmokeMarch march = startOfMarch(ray);
  SmokeMarch rest = march;  // after the knots that are kept
  SmokeKnot knot;
  SmokeKnot last = march.segment;
  float steepest = 0.0;
  uint count = 0u;
  while (goesOn(march, ray)) {
    if (marchStep(ray, march, knot)) {
      if (count < KEPT) kept[count] = knot;
      if (count != 0u) steepest = max(steepest, steepness(last, knot));
      last = knot;
      ++count;
      if (count == KEPT) rest = march;
    }
  }
#ifdef COLOURED_SMOKE
  uint flags = 0u;
#else
  uint flags = SHADOW_GREY;
#endif
  if (count != 0u && shortShare() > 0.0) {
    uint startBits = uint(min(kept[0].depth / last.depth * SHADOW_STARTS, SHADOW_STARTS - 1.0)) << SHADOW_START_BIT;
    start = shortStart(startBits, last.depth);
    steps = shortSteps(start, last.depth);
    isShort = maxComponent(last.tau) <= SHADOW_SHORT_TAU && count <= SHADOW_SHORT_KNOTS &&
              0.5 * steepest / steps + SHORT_TAU_ERROR <= shortShare() * params.march.y;
    if (isShort) flags |= SHADOW_SHORT | startBits;
  }
  uint units = smokeUnits(count, isShort);
  uint first;
  if (!takeUnits(units, first)) return;
  texels[numberOfCell()] = ShadowTexel(uint(params.units.x) + first, count | flags, last.depth);

  place = 4u * first;
  for (uint i = 0u; i < min(count, KEPT); ++i) writeKnot(kept[i]);
  // A march that gave other knots this time could not write beyond its own.
  uint left = count > KEPT ? count - KEPT : 0u;
  while (left != 0u && goesOn(rest, ray)) {
    if (marchStep(ray, rest, knot)) {
      writeKnot(knot);
      --left;
    }
  }
  for (; left != 0u; --left) writeKnot(last);
  if (!isShort) last.depth = NOTHING_OPAQUE;
  for (; count < units << knotsShift(isShort); ++count) writeKnot(last);
}
