// How much of a light gets to a point. Every function here reads maps that deepshadow/maps_gpu built. VOLUME_COUNT is
// defined when there is smoke, NEAREST_SMOKE_SHADOWS when lookups of points in it ask one texel of surfaces, OPAQUE_SHADOWS
// when no surface lets light through, NO_CASTERS when none casts a shadow.
#include "shaders/deepshadow/faces.glsl"
#include "shaders/deepshadow/smoke_knot.glsl"

// As buffer textures, because all maps together may be larger than one storage block.
layout(binding = TEXTURE_SHADOW_TEXELS) uniform usamplerBuffer shadowTexels;  // ShadowTexel
#ifndef WALK_LISTS
layout(binding = TEXTURE_SHADOW_KNOTS) uniform usamplerBuffer shadowKnots;    // units: see ShadowTexel
#endif

ShadowTexel shadowTexel(uint number) {
  uvec3 words = texelFetch(shadowTexels, int(number)).xyz;
  return ShadowTexel(words.x, words.y, uintBitsToFloat(words.z));
}

uint knotCount(ShadowTexel texel) {
  return texel.count & ((texel.count & SHADOW_SHORT) != 0u ? SHADOW_SHORT_KNOTS : SHADOW_KNOTS);
}

#ifdef WALK_LISTS
#include "shaders/deepshadow/walk.glsl"
#else

vec4 knotUnit(uint number) {
  return uintBitsToFloat(texelFetch(shadowKnots, int(number)));
}

// How many of a texel's units begin at or before a depth, at least `first`, found by bisection: the last of them and the next
// one, where there are such. `key`: the largest first word of a unit that does.
uint unitsBefore(ShadowTexel texel, uint units, uint first, uint key, out uvec4 before, out uvec4 after) {
  uint low = first;
  uint high = units;   // units [0, low) begin at or before depth, units [high, units) behind it
  before = uvec4(0u);  // unit low - 1
  after = uvec4(0u);   // unit high
  while (low < high) {
    uint middle = (low + high) >> 1;
    uvec4 unit = texelFetch(shadowKnots, int(texel.first + middle));
    if (unit.x <= key) {
      low = middle + 1u;
      before = unit;
    } else {
      high = middle;
      after = unit;
    }
  }
  return low;
}

// Floats above 0 have the order of their bits.
uint keyOf(float depth) {
  return floatBitsToUint(max(depth, 1e-30));
}

// Optical depth from the light to `depth` in a texel of surfaces that has knots: that of the last one before it.
vec3 opticalDepthAt(ShadowTexel texel, float depth) {
  bool grey = (texel.count & SHADOW_GREY) != 0u;
  uint units = grey ? (knotCount(texel) + 1u) >> 1 : knotCount(texel);
  uint key = keyOf(depth);
  uvec4 unit, next;
  if (unitsBefore(texel, units, 0u, key, unit, next) == 0u) return vec3(0.0);
  if (!grey) return uintBitsToFloat(unit.yzw);
  return vec3(uintBitsToFloat(unit.z <= key ? unit.w : unit.y));
}

#ifdef VOLUME_COUNT
// The same in a texel of smoke: linear from the last knot before it to the next one.
Extinction smokeOpticalDepthAt(ShadowTexel texel, float depth) {
  bool isShort = (texel.count & SHADOW_SHORT) != 0u;
  float last = texel.opaqueDepth;
  uint units = smokeUnits(knotCount(texel), isShort);
  uint first = depth < last ? 0u : units - 1u;
  uint key = keyOf(depth);
  if (isShort) {
    float start = shortStart(texel.count, last);
    depth = clamp((depth - start) * shortSteps(start, last), 0.0, SHADOW_SHORT_DEPTHS);
    key = shortKey(depth);
  }
  uvec4 unit, next;
  uint begun = unitsBefore(texel, units, first, key, unit, next);
  if (begun == 0u) return Extinction(0.0);
  if (begun == units) next = unitBehind(unit, isShort);
  SmokeKnot before, after;
  knotsAround(unit, next, key, isShort, before, after);
  float run = after.depth - before.depth;
  return mix(before.tau, after.tau, run > 0.0 ? (depth - before.depth) / run : 0.0);
}
#endif

#endif

// Through surfaces that let light pass; `ownTau` is taken out.
vec3 runTransmittance(ShadowTexel texel, float depth, vec3 ownTau) {
#ifdef OPAQUE_SHADOWS
  return vec3(1.0);
#else
  return knotCount(texel) == 0u ? vec3(1.0) : exp(min(ownTau - opticalDepthAt(texel, depth), 0.0));
#endif
}

// Walks the own steps of a texel (see ShadowTexel) up to `depth`: gives what those of `object` add to the optical
// depth at `depth - slack`, and makes the first opaque one of another object the texel's opaque depth.
vec3 takeOwnSteps(inout ShadowTexel texel, float depth, float slack, uint object) {
  vec3 ownTau = vec3(0.0);
#ifdef SHADOW_OBJECTS
  uint number = texel.first + knotCount(texel);
  vec4 listed = vec4(0.0);
  if ((texel.count & SHADOW_OWN_STEPS) != 0u) listed = knotUnit(number);
  while (listed.y != 0.0 && listed.x <= depth) {
    if (uint(listed.y) == object && listed.x <= depth - slack) {
      uint step = uint(listed.z);
      ownTau += knotUnit(texel.first + step).yzw;
      if (step != 0u) ownTau -= knotUnit(texel.first + step - 1u).yzw;
    } else if (uint(listed.y) != object && listed.w != 0.0) {
      texel.opaqueDepth = min(texel.opaqueDepth, listed.x);
    }
    ++number;
    listed = knotUnit(number);
  }
#endif
  return ownTau;
}

// Smoke aside.
vec3 texelTransmittance(uint number, float depth) {
  ShadowTexel texel = shadowTexel(number);
  return depth > texel.opaqueDepth ? vec3(0.0) : runTransmittance(texel, depth, vec3(0.0));
}

uint texelNumber(ShadowFace face, ivec2 texel) {
  texel = clamp(texel, ivec2(0), ivec2(face.texels.y - 1));
  return uint(face.texels.x + texel.y * face.texels.y + texel.x);
}

// Of its surfaces, then of its smoke.
int texelsOfFace(ShadowFace face) {
  return face.texels.y * face.texels.y + face.texels.w * face.texels.w;
}

// Of the smoke, at a place in texels of surfaces.
vec2 smokePlace(ShadowFace face, vec2 place) {
  return place * (float(face.texels.w) / float(face.texels.y));
}

uint smokeTexelNumber(ShadowFace face, ivec2 texel) {
  texel = clamp(texel, ivec2(0), ivec2(face.texels.w - 1));
  return uint(face.texels.x + face.texels.y * face.texels.y + texel.y * face.texels.w + texel.x);
}

// Through the smoke before a point: the optical depths of the four texels around it, bilinearly.
vec3 smokeTransmittance(ShadowFace face, vec2 place, float depth) {
#if defined(VOLUME_COUNT) && !defined(WALK_LISTS)
  Extinction tau = Extinction(0.0);
  Taps taps = tapsAround(smokePlace(face, place), 2);
  for (int i = 0; i < 4; ++i) {
    ivec2 offset = tapOffset(i, 2);
    ShadowTexel texel = shadowTexel(smokeTexelNumber(face, taps.first + offset));
    if (knotCount(texel) != 0u)
      tau += taps.x[offset.x] * taps.y[offset.y] * smokeOpticalDepthAt(texel, depth);
  }
  return vec3(exp(-tau));
#else
  return vec3(1.0);
#endif
}

// Of a point in smoke, in the view space of the face that sees it; `side`, of texels of surfaces: see Taps. Those of smoke are
// too wide for one to do.
vec3 shadowInSmoke(ShadowFace face, vec3 pFace, int side) {
  float depth = -pFace.z;
  vec2 xy = face.texels.z != 0 ? pFace.xy / max(depth, 1e-20) : pFace.xy;
  vec2 place = xy * face.projection.xy + face.projection.zw;
#if defined(NO_CASTERS)
  return smokeTransmittance(face, place, depth);
#elif defined(NEAREST_SMOKE_SHADOWS)
  return texelTransmittance(texelNumber(face, ivec2(floor(place))), depth) * smokeTransmittance(face, place, depth);
#else
  Taps taps = tapsAround(place, side);
  vec3 sum = vec3(0.0);
  for (int i = 0; i < side * side; ++i) {
    ivec2 offset = tapOffset(i, side);
    sum += taps.x[offset.x] * taps.y[offset.y] * texelTransmittance(texelNumber(face, taps.first + offset), depth);
  }
  return sum * smokeTransmittance(face, place, depth);
#endif
}

// The opaque depth that a texel's surface would have `offset` texels away from its centre, towards a point, if it went on
// as it does from the texels on its far side: exact for a plane. Very near where they have another surface, or none.
float opaqueDepthFrom(ShadowFace face, ivec2 texel, float depth, vec2 offset) {
  ivec2 outwards = ivec2(sign(offset));
  float besideX = uintBitsToFloat(texelFetch(shadowTexels, int(texelNumber(face, texel + ivec2(outwards.x, 0)))).z);
  float besideY = uintBitsToFloat(texelFetch(shadowTexels, int(texelNumber(face, texel + ivec2(0, outwards.y)))).z);
  if (face.texels.z == 0) return depth + dot(abs(offset), vec2(depth) - vec2(besideX, besideY));
  // Seen in perspective, the inverse of a plane's depth is linear.
  float inverse = 1.0 / depth + dot(abs(offset), 1.0 / vec2(depth) - 1.0 / vec2(besideX, besideY));
  return inverse > 0.0 ? 1.0 / inverse : 3e38;
}

// Texels that a plane goes deeper in the width of a few, where it is seen edge-on.
const float EDGE_ON = 512.0;

// A texel as a point on a surface asks it.
struct SurfaceTap {
  ivec2 at;
  float share;
  float depth;  // where the ray through its centre meets the point's plane, or a little before
  float slack;  // by how much nearer surfaces may be without shadowing the point for sure
  ShadowTexel texel;
  vec3 ownTau;  // see takeOwnSteps
};

// The point on a surface, in the view space of the face that sees it.
struct SurfacePlace {
  vec3 p;
  vec3 normal;
  float depth;
  vec2 place;        // in texels
  float texelWidth;  // m, there
  float rounding;    // m, of depths
  uint object;
};

SurfaceTap surfaceTap(ShadowFace face, SurfacePlace point, Taps taps, int i, int side) {
  ivec2 offset = tapOffset(i, side);
  SurfaceTap tap;
  tap.at = taps.first + offset;
  tap.share = taps.x[offset.x] * taps.y[offset.y];
  vec2 xy = (vec2(tap.at) + 0.5 - face.projection.zw) / face.projection.xy;
  // The plane dot(n, x) = dot(n, p), met by x = (xy depth, -depth) or x = (xy, -depth). Seen edge-on it is met far
  // away or nowhere; little light falls on it then, and the point's own depth will do.
  vec3 n = point.normal;
  tap.depth = face.texels.z != 0 ? dot(n, point.p) / dot(n, vec3(xy, -1.0)) : (dot(n.xy, xy) - dot(n, point.p)) / n.z;
  if (!(abs(tap.depth - point.depth) < EDGE_ON * point.texelWidth)) tap.depth = point.depth;
  tap.slack = point.texelWidth + 0.3 * abs(tap.depth - point.depth);
  tap.depth -= point.rounding;
  tap.texel = shadowTexel(texelNumber(face, tap.at));
  tap.ownTau = takeOwnSteps(tap.texel, tap.depth, tap.slack, point.object);
  return tap;
}

// Of a point on a surface of `object` (see PackedSurface) with the plane normal `normal`: the texels around it (`side`: see
// Taps), each asked at the depth at which the ray through its centre meets that plane, so that a flat surface neither shadows itself
// nor leaks, whatever the angle and the resolution. What lies before the plane by less than a texel or two is where a texel
// cannot tell: another surface that joins this one in a corner, or this one where it is curved. An opaque texel of
// that kind is left out as long as others tell something, and lit where none does; a translucent one is looked up that
// much earlier.
vec3 shadowOnSurface(int firstFace, int faces, vec3 lightPosition, vec3 pWorld, vec3 normal, uint object,
                     int side) {
  ShadowFace face = shadowFaceAt(firstFace + faceTowards(faces, pWorld - lightPosition));
  SurfacePlace point;
  point.p = (face.faceFromWorld * vec4(pWorld, 1.0)).xyz;
  point.normal = mat3(face.faceFromWorld) * normal;
  bool perspective = face.texels.z != 0;
  point.depth = -point.p.z;
  point.place = (perspective ? point.p.xy / max(point.depth, 1e-20) : point.p.xy) * face.projection.xy + face.projection.zw;
  point.texelWidth = (perspective ? point.depth : 1.0) / min(face.projection.x, face.projection.y);
  point.rounding = 1e-4 * abs(point.depth) + 1e-3 * point.texelWidth;
  point.object = object;
  Taps taps = tapsAround(point.place, side);
  vec3 sum = vec3(0.0);
  float told = 0.0;
  vec3 doubtful = vec3(0.0);
  uint near = 0u;
  for (int i = 0; i < side * side; ++i) {
    SurfaceTap tap = surfaceTap(face, point, taps, i, side);
    float opaque = tap.texel.opaqueDepth;
    bool lit = tap.depth <= opaque;
    float before = min(tap.depth, point.depth) - tap.slack - opaque;
    bool blocked = before > EDGE_ON * point.texelWidth;
    // At a grazing angle the plane is met far on the light's side of the point: with something else in between, the
    // texel tells only where no other does.
    if (lit && opaque > tap.depth + 4.0 * point.rounding && opaque < point.depth - point.texelWidth) tap.share *= 1e-6;
    vec3 through = tap.share * runTransmittance(tap.texel, min(tap.depth, opaque) - tap.slack, tap.ownTau);
    if (lit || blocked) told += tap.share;
    if (lit) sum += through;
    else doubtful += through;
    if (before > 0.0 && !blocked) near |= 1u << i;
  }
  // Apart, because some drivers run what few texels need for all of them.
  while (near != 0u) {
    SurfaceTap tap = surfaceTap(face, point, taps, findLSB(near), side);
    near &= near - 1u;
    if (opaqueDepthFrom(face, tap.at, tap.texel.opaqueDepth, vec2(tap.at) + 0.5 - point.place) < point.depth - tap.slack)
      told += tap.share;
  }
  vec3 through = told > 0.0 ? sum / told : doubtful;
  bool smoky = all(greaterThan(point.place, face.smoke.xy)) && all(lessThan(point.place, face.smoke.zw));
  return smoky ? through * smokeTransmittance(face, point.place, point.depth - point.rounding) : through;
}
