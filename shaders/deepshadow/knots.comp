// Writes the knots of each texel's function: those of the smoke, marched from the light to the opaque depth, and two for
// each surface of the texel's run, in order of depth. So a lookup is a binary search and no walk. A texel an invocation:
// knots are counted, then taken from the pool, then written; a texel that finds no room waits for the next dispatch.
// Smoke comes in order of depth by itself: it needs no list. Its knots are kept while they are counted; what is more
// than a few is marched again.
// A texel of very many surfaces keeps its state in its last knots, and goes on in the next dispatch.
// VOLUME_COUNT is defined when there are media, SURFACES when there are lists; SHADOW_ONCE_OBJECTS and
// SHADOW_NOT_SELF_OBJECTS when some of their surfaces shadow in these ways.
#include "shaders/shared/bindings.h"
#include "shaders/shared/deepshadow.h"
#include "shaders/shared/geometry.h"
#include "shaders/shared/linear_id.glsl"
#include "shaders/shared/view_block.glsl"
#include "shaders/deepshadow/smoke_knot.glsl"
#include "shaders/lists/runs.glsl"
#ifdef VOLUME_COUNT
#include "shaders/deepshadow/smoke_march.glsl"
#endif

layout(std140, binding = UNIFORM_PASS) uniform Pass {
  ShadowPassParams params;
};
layout(binding = TEXTURE_OPAQUE_DEPTH) uniform sampler2D opaqueDepth;
layout(std430, binding = STORAGE_SHADOW_TEXELS) buffer Texels {
  ShadowTexel texels[];
};
layout(std430, binding = STORAGE_SHADOW_KNOTS) buffer Knots {
  vec2 halves[];  // of the pool's units
};
layout(std430, binding = STORAGE_COUNTERS) coherent buffer Counting {
  ShadowCounters counters;
};

const uint NO_ROOM = 0xffffffffu;  // a count
const uint UNFINISHED = 0xfffffffeu;  // likewise
// Surfaces looked at in one dispatch, so that all loops together stay below the drivers' limit.
#ifndef WALK_LIMIT
#ifdef SHADOW_NOT_SELF_OBJECTS
#define WALK_LIMIT 15000u
#else
#define WALK_LIMIT 30000u
#endif
#endif
const float NOWHERE = 3e38;

uint place = 0u;           // the next half
uint walked = 0u;
bool grey = true;          // so that a knot takes half a unit
#ifdef SURFACES
ListRun run = ListRun(0u, 0u);
uint surface = 0u;         // of the run, the next one
uint firstUnit = 0u;
uint ownStep = 0u;         // unit of the next one
vec3 surfaceTau = vec3(0.0);
uint hidden = 0u;
bool stopped = false;      // the rest is for the next dispatch
uint searched = 0u;        // of the surfaces before the next one, for one of its object
uint smokeWritten = 0u;    // knots of the smoke
uint smokeSkipped = 0u;    // that were written by former dispatches

// What a surface takes; nothing where a former one of the same object shadows once. Stops when it takes another
// dispatch to find that out.
ShadowNode surfaceNode(uint number) {
  uvec2 words = listPayloadPair(run.first + number);
#ifdef SHADOW_ONCE_OBJECTS
  uint object = words.y >> 16;
  if ((object & uint(SHADOW_ONCE)) != 0u) {
    bool shadowed = false;
    while (searched < number && !shadowed && walked < WALK_LIMIT) {
      shadowed = listPayloadPair(run.first + searched).y >> 16 == object;
      ++searched;
      ++walked;
    }
    if (shadowed) words = uvec2(0u);
    else stopped = searched < number;
  }
#endif
  return ShadowNode(words.x, words.y);
}

// What goes on in the next dispatch; the last two knots are free for it, as a surface is still to come.
void keepState(uint lastUnit) {
  uint half_ = 2u * lastUnit - 2u;
  halves[half_] = uintBitsToFloat(uvec2(surface, place));
  halves[half_ + 1u] = uintBitsToFloat(uvec2(ownStep, smokeWritten));
  halves[half_ + 2u] = vec2(uintBitsToFloat(searched), surfaceTau.r);
  halves[half_ + 3u] = surfaceTau.gb;
}

void takeState(uint lastUnit) {
  uint half_ = 2u * lastUnit - 2u;
  surface = floatBitsToUint(halves[half_].x);
  place = floatBitsToUint(halves[half_].y);
  ownStep = floatBitsToUint(halves[half_ + 1u].x);
  smokeWritten = floatBitsToUint(halves[half_ + 1u].y);
  searched = floatBitsToUint(halves[half_ + 2u].x);
  surfaceTau = vec3(halves[half_ + 2u].y, halves[half_ + 3u]);
  smokeSkipped = smokeWritten;
}

uint objectOf(ShadowNode node) {
  return node.tauBObject >> 16;
}

// Whether all surfaces take as much of each channel; where there are many nobody looks.
bool surfacesAreGrey() {
  const uint FEW = 64u;
  bool same = run.count <= FEW;
  for (uint i = 0u; i < run.count && same; ++i) {
    uvec2 words = listPayloadPair(run.first + i);
    uint tauR = words.x & 0xffffu;
    same = words.x >> 16 == tauR && (words.y & 0xffffu) == tauR;
  }
  return same;
}
#else
const vec3 surfaceTau = vec3(0.0);
#endif

void writeKnot(float depth, vec3 tau) {
  halves[place] = vec2(depth, tau.r);
  ++place;
  if (!grey) {
    halves[place] = tau.gb;
    ++place;
  }
}

// Knots of the surfaces up to a depth, between the smoke's knot that was written last and its next one.
void writeSurfaces(SmokeKnot before, SmokeKnot next, float opaque) {
#ifdef SURFACES
  while (surface < run.count && !stopped && listDepth(run.first + surface) <= next.depth) {
    float at = listDepth(run.first + surface);
    ShadowNode node = surfaceNode(surface);
    if (stopped) continue;
    vec3 drop = vec3(unpackHalf2x16(node.tauRg), unpackHalf2x16(node.tauBObject).x);
    float along = clamp((at - before.depth) / max(next.depth - before.depth, 1e-30), 0.0, 1.0);
    vec3 smokeTau = vec3(mix(before.tau, next.tau, along));
#ifdef SHADOW_NOT_SELF_OBJECTS
    if ((objectOf(node) & uint(SHADOW_NOT_SELF)) != 0u) {
      bool isOpaque = min(min(drop.r, drop.g), drop.b) >= SHADOW_DARK_TAU;
      halves[2u * ownStep] = vec2(at, float(objectOf(node)));
      halves[2u * ownStep + 1u] = vec2(float(place / 2u - firstUnit), isOpaque ? 1.0 : 0.0);
      ++ownStep;
    }
#endif
    writeKnot(at, surfaceTau + smokeTau);
    surfaceTau += drop;
    writeKnot(at, surfaceTau + smokeTau);
    if (at > opaque) ++hidden;
    ++surface;
    ++walked;
    searched = 0u;
    stopped = walked >= WALK_LIMIT && surface < run.count;
  }
#endif
}

// A knot of the smoke, after the surfaces before it.
void writeSmokeKnot(inout SmokeKnot before, SmokeKnot smoke, float opaque) {
#ifdef SURFACES
  if (smokeSkipped != 0u) {
    --smokeSkipped;
    before = smoke;
  } else {
    writeSurfaces(before, smoke, opaque);
    if (!stopped) {
      writeKnot(smoke.depth, surfaceTau + smoke.tau);
      before = smoke;
      ++smokeWritten;
    }
  }
#else
  writeKnot(smoke.depth, surfaceTau + smoke.tau);
  before = smoke;
#endif
}

#ifdef VOLUME_COUNT
const uint KEPT = 24u;
SmokeKnot kept[KEPT];

SmokeRay smokeRay(ivec2 texel, float opaque) {
  vec2 plane = ((vec2(texel) + 0.5) / vec2(view.size.xy) * 2.0 - 1.0) * view.halfExtent.xy;
  bool orthographic = view.halfExtent.z != 0.0;
  vec3 originView = orthographic ? vec3(plane, 0.0) : vec3(0.0);
  vec3 perDepthView = orthographic ? vec3(0.0, 0.0, -1.0) : vec3(plane, -1.0);
  vec3 origin = (view.worldFromView * vec4(originView, 1.0)).xyz;
  vec3 perDepth = mat3(view.worldFromView) * perDepthView;
  SmokeRay ray;
  ray.media = mediaRay(origin, perDepth, vec2(0.0, opaque), params.march.x);
  ray.end = ray.media.rangeOfAll.y;
  ray.metresPerDepth = length(perDepth);
  ray.bound = params.march.y;
  float tooMany = ray.media.rangeOfAll.x < ray.end ? stepsAtMost(ray.media) / MAX_STEPS : 0.0;
  if (tooMany > 1.0) {
    atomicAdd(counters.boundHit, 1u);
    for (int v = 0; v < VOLUME_COUNT; ++v) ray.media.stride[v] *= tooMany;
  }
  return ray;
}
#endif

void main() {
  if (linearId() >= uint(params.cells.y)) return;
  uint cell = uint(params.cells.x) + linearId();
  uint number = uint(params.cells.w) + linearId();
  bool continuing = params.units.y == SHADOW_UNFINISHED;
  if (params.units.y != SHADOW_ALL && texels[number].count != (continuing ? UNFINISHED : NO_ROOM)) return;
  ivec2 texel = ivec2(int(cell) % view.size.x, int(cell) / view.size.x);
  float opaque = texelFetch(opaqueDepth, texel, 0).r;

  uint smokeCount = 0u;
#ifdef VOLUME_COUNT
  SmokeRay ray = smokeRay(texel, opaque);
  SmokeMarch march = startOfMarch(ray);
  SmokeMarch rest = march;  // after the knots that are kept
  SmokeKnot fixedKnot;
  while (goesOn(march, ray)) {
    if (marchStep(ray, march, fixedKnot)) {
      if (smokeCount < KEPT) kept[smokeCount] = fixedKnot;
      ++smokeCount;
      if (smokeCount == KEPT) rest = march;
    }
  }
#endif
  uint count = smokeCount;
  uint ownSteps = 0u;
#ifdef SURFACES
  run = listRun(uint(params.cells.z) + linearId());
  count += 2u * run.count;
#ifdef SHADOW_NOT_SELF_OBJECTS
  // At most; of very many surfaces each could be one.
  for (uint i = 0u; i < min(run.count, WALK_LIMIT); ++i)
    if ((listPayloadPair(run.first + i).y >> 16 & uint(SHADOW_NOT_SELF)) != 0u) ++ownSteps;
  if (run.count > WALK_LIMIT) ownSteps = run.count;
  if (ownSteps != 0u) ++ownSteps;  // their end
#endif
  grey = ownSteps == 0u && surfacesAreGrey();
#endif
#ifdef COLOURED_SMOKE
  if (smokeCount != 0u) grey = false;
#endif

  uint all = (grey ? (count + 1u) / 2u : count) + ownSteps;
  uint first = continuing ? texels[number].first - uint(params.units.x) : 0u;
  if (all != 0u && !continuing) first = atomicAdd(counters.units, all);
  if (all != 0u && first + all > uint(halves.length()) / 2u) {
    atomicAdd(counters.unplaced, all);
    texels[number].count = NO_ROOM;
    return;
  }
  uint flags = (grey ? SHADOW_GREY : 0u) | (ownSteps != 0u ? SHADOW_OWN_STEPS : 0u);
  texels[number] = ShadowTexel(uint(params.units.x) + first, count | flags, opaque);

  place = 2u * first;
#ifdef SURFACES
  firstUnit = first;
  ownStep = first + count;
  if (continuing) takeState(first + count - 1u);
#endif
  SmokeKnot before = SmokeKnot(0.0, Extinction(0.0));
#ifdef VOLUME_COUNT
  for (uint i = 0u; i < min(smokeCount, KEPT); ++i) writeSmokeKnot(before, kept[i], opaque);
  // A march that gave other knots this time could not write beyond its own.
  uint left = smokeCount > KEPT ? smokeCount - KEPT : 0u;
  while (left != 0u && goesOn(rest, ray)) {
    if (marchStep(ray, rest, fixedKnot)) {
      writeSmokeKnot(before, fixedKnot, opaque);
      --left;
    }
  }
  for (; left != 0u; --left) writeSmokeKnot(before, before, opaque);
#endif
  writeSurfaces(before, SmokeKnot(NOWHERE, before.tau), opaque);
  if (grey && (count & 1u) != 0u) writeKnot(NOTHING_OPAQUE, surfaceTau + before.tau);
#ifdef SURFACES
#ifdef SHADOW_NOT_SELF_OBJECTS
  if (ownSteps != 0u && !stopped) {
    halves[2u * ownStep] = vec2(0.0);
    halves[2u * ownStep + 1u] = vec2(0.0);
  }
#endif
  if (stopped) {
    keepState(first + count - 1u);
    texels[number].count = UNFINISHED;
    atomicAdd(counters.unfinished, 1u);
  }
  if (hidden != 0u) atomicAdd(counters.hidden, hidden);
#endif
}
