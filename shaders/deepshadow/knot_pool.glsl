// Texels of a face whose knots are written, an invocation each: knots are counted, then taken from the pool, then written;
// a texel that finds no room waits for the next dispatch.
#include "shaders/shared/bindings.h"
#include "shaders/shared/deepshadow.h"
#include "shaders/shared/linear_id.glsl"
#include "shaders/shared/view_block.glsl"

layout(std140, binding = UNIFORM_PASS) uniform Pass {
  ShadowPassParams params;
};
layout(binding = TEXTURE_OPAQUE_DEPTH) uniform sampler2D opaqueDepth;
layout(std430, binding = STORAGE_SHADOW_TEXELS) buffer Texels {
  ShadowTexel texels[];
};
layout(std430, binding = STORAGE_SHADOW_KNOTS) buffer Knots {
  uint words[];  // four are a unit of the pool
};
layout(std430, binding = STORAGE_COUNTERS) coherent buffer Counting {
  ShadowCounters counters;
};

const uint NO_ROOM = 0xffffffffu;     // a count
const uint UNFINISHED = 0xfffffffeu;  // likewise

uint place = 0u;  // of the next word

// Of the invocation, in the face.
ivec2 texelOfCell() {
  uint cell = uint(params.cells.x) + linearId();
  return placeInRows(cell, view.size.x);
}

// Among the texels that are bound.
uint numberOfCell() {
  return uint(params.cells.w) + linearId();
}

// Whether the invocation has a texel, of those that this dispatch is for.
bool isWritten() {
  if (linearId() >= uint(params.cells.y)) return false;
  if (params.units.y == SHADOW_ALL) return true;
  return texels[numberOfCell()].count == (params.units.y == SHADOW_UNFINISHED ? UNFINISHED : NO_ROOM);
}

// Takes so many units of the pool. False, and NO_ROOM for the texel, when there are not as many.
bool takeUnits(uint count, out uint first) {
  first = count != 0u ? atomicAdd(counters.units, count) : 0u;
  bool fits = count == 0u || first + count <= uint(words.length()) / 4u;
  if (!fits) {
    atomicAdd(counters.unplaced, count);
    texels[numberOfCell()].count = NO_ROOM;
  }
  return fits;
}

void writeWord(uint word) {
  words[place] = word;
  ++place;
}
