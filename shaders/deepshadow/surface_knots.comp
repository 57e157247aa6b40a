// Writes the texels of a face, and a knot for each surface of a texel's run, in order of depth. So a lookup is a binary
// search and no walk. A texel of very many surfaces keeps its state in its last units, and goes on in the next dispatch.
// SURFACES is defined when there are lists; SHADOW_ONCE_OBJECTS and SHADOW_NOT_SELF_OBJECTS when some of their surfaces
// shadow in these ways.
#include "shaders/deepshadow/knot_pool.glsl"
#ifdef SURFACES
#include "shaders/lists/runs.glsl"
#include "shaders/shared/geometry.h"

// Surfaces looked at in one dispatch, so that all loops together stay below the drivers' limit.
#ifndef WALK_LIMIT
#ifdef SHADOW_NOT_SELF_OBJECTS
#define WALK_LIMIT 15000u
#else
#define WALK_LIMIT 30000u
#endif
#endif

const uint FEW = 64u;  // surfaces, of which one dispatch surely sees the end

bool grey = true;          // so that a knot takes half a unit
uint walked = 0u;
ListRun run = ListRun(0u, 0u);
uint surface = 0u;         // of the run, the next one
uint firstUnit = 0u;
uint ownStep = 0u;         // unit of the next one
vec3 surfaceTau = vec3(0.0);
uint hidden = 0u;
bool stopped = false;      // the rest is for the next dispatch
uint searched = 0u;        // of the surfaces before the next one, for one of its object

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

// What goes on in the next dispatch; the last two units are free for it, as a surface is still to come.
void keepState(uint lastUnit) {
  uint word = 4u * lastUnit - 4u;
  words[word] = surface;
  words[word + 1u] = place;
  words[word + 2u] = ownStep;
  words[word + 3u] = searched;
  for (int i = 0; i < 3; ++i) words[word + 4u + uint(i)] = floatBitsToUint(surfaceTau[i]);
}

void takeState(uint lastUnit) {
  uint word = 4u * lastUnit - 4u;
  surface = words[word];
  place = words[word + 1u];
  ownStep = words[word + 2u];
  searched = words[word + 3u];
  for (int i = 0; i < 3; ++i) surfaceTau[i] = uintBitsToFloat(words[word + 4u + uint(i)]);
}

uint objectOf(ShadowNode node) {
  return node.tauBObject >> 16;
}

// Whether all surfaces take as much of each channel; where there are many nobody looks.
bool surfacesAreGrey() {
  bool same = run.count <= FEW;
  for (uint i = 0u; i < run.count && same; ++i) {
    uvec2 words = listPayloadPair(run.first + i);
    uint tauR = words.x & 0xffffu;
    same = words.x >> 16 == tauR && (words.y & 0xffffu) == tauR;
  }
  return same;
}

void writeKnot(float depth, vec3 tau) {
  writeWord(floatBitsToUint(depth));
  writeWord(floatBitsToUint(tau.r));
  if (!grey) {
    writeWord(floatBitsToUint(tau.g));
    writeWord(floatBitsToUint(tau.b));
  }
}

void writeSurfaces(float opaque) {
  while (surface < run.count && !stopped) {
    float at = listDepth(run.first + surface);
    ShadowNode node = surfaceNode(surface);
    if (stopped) continue;
    vec3 drop = vec3(unpackHalf2x16(node.tauRg), unpackHalf2x16(node.tauBObject).x);
#ifdef SHADOW_NOT_SELF_OBJECTS
    if ((objectOf(node) & uint(SHADOW_NOT_SELF)) != 0u) {
      bool isOpaque = min(min(drop.r, drop.g), drop.b) >= SHADOW_DARK_TAU;
      vec4 listed = vec4(at, objectOf(node), place / 4u - firstUnit, isOpaque ? 1.0 : 0.0);
      for (int i = 0; i < 4; ++i) words[4u * ownStep + uint(i)] = floatBitsToUint(listed[i]);
      ++ownStep;
    }
#endif
    surfaceTau += drop;
    writeKnot(at, surfaceTau);
    if (at > opaque) ++hidden;
    ++surface;
    ++walked;
    searched = 0u;
    stopped = walked >= WALK_LIMIT && surface < run.count;
  }
}

// Of objects that do not shadow themselves, at most: of very many surfaces each could be one. And their end.
uint ownStepsAtMost() {
  uint steps = 0u;
#ifdef SHADOW_NOT_SELF_OBJECTS
  for (uint i = 0u; i < min(run.count, WALK_LIMIT); ++i)
    if ((listPayloadPair(run.first + i).y >> 16 & uint(SHADOW_NOT_SELF)) != 0u) ++steps;
  if (run.count > WALK_LIMIT) steps = run.count;
  if (steps != 0u) ++steps;
#endif
  return steps;
}
#endif

void main() {
  if (!isWritten()) return;
  uint number = numberOfCell();
  float opaque = texelFetch(opaqueDepth, texelOfCell(), 0).r;
#ifdef SURFACES
  bool continuing = params.units.y == SHADOW_UNFINISHED;
  run = listRun(uint(params.cells.z) + linearId());
  uint ownSteps = ownStepsAtMost();
  grey = ownSteps == 0u && surfacesAreGrey();
  uint units = grey ? (run.count + 1u) / 2u : run.count;
  uint stateUnits = run.count > FEW ? 1u : 0u;
  uint first = 0u;
  if (continuing) first = texels[number].first - uint(params.units.x);
  else if (!takeUnits(units + ownSteps + stateUnits, first)) return;
  uint lastUnit = first + units + ownSteps + stateUnits - 1u;
  uint flags = (grey ? SHADOW_GREY : 0u) | (ownSteps != 0u ? SHADOW_OWN_STEPS : 0u);
  texels[number] = ShadowTexel(uint(params.units.x) + first, run.count | flags, opaque);

  place = 4u * first;
  firstUnit = first;
  ownStep = first + units;
  if (continuing) takeState(lastUnit);
  writeSurfaces(opaque);
  if (grey && (run.count & 1u) != 0u) writeKnot(NOTHING_OPAQUE, surfaceTau);
#ifdef SHADOW_NOT_SELF_OBJECTS
  if (ownSteps != 0u && !stopped) {
    for (uint i = 0u; i < 4u; ++i) words[4u * ownStep + i] = 0u;
  }
#endif
  if (stopped) {
    keepState(lastUnit);
    texels[number].count = UNFINISHED;
    atomicAdd(counters.unfinished, 1u);
  }
  if (hidden != 0u) atomicAdd(counters.hidden, hidden);
#else
  texels[number] = ShadowTexel(0u, 0u, opaque);
#endif
}
