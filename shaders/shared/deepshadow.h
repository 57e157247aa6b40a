// Deep shadow maps: per texel a transmittance function of the depth seen from the light.
#pragma once
#include "shaders/shared/glsl.h"
SHARED_BEGIN

// One projection of a light: a whole map for directional and spot lights, one of six for lights that need a cube.
struct ShadowFace {
  mat4 faceFromWorld;  // view space of the face; depth is along -Z
  vec4 projection;     // texel = xy * scale + offset; xy is divided by depth first when perspective
  // x: number of its first texel, y: side, z: 1 for perspective; w: side of its texels of smoke, which stand behind the
  // others, 0: none; of interlaced maps, first column
  ivec4 texels;
  vec4 smoke;  // what of the face smoke can be before, in texels: x, y from, z, w to
};

// The function of one texel is 0 behind its opaque depth; before it, exp(-tau). Of smoke, tau is linear between its knots; of
// surfaces each knot is a step up to its tau. Those of surfaces and those of smoke are multiplied.
// The pool's unit is 16 bytes: one knot of a coloured texel, two (depth, tau) of a grey one, whose odd last is followed
// by one at NOTHING_OPAQUE. Where that keeps the bound of their error, knots of smoke are short: a word of a grey one
// (shaders/deepshadow/smoke_knot.glsl), two of a coloured one, the last repeated to the end of its unit.
// Steps of objects that do not shadow themselves stand in the list once more, behind those knots, so that they can be
// taken out again: as knots of (depth, object, number of the step's knot, 1 where opaque), ended by one of object 0.
struct ShadowTexel {
  uint first;         // unit of the pool
  uint count;         // knots; and SHADOW_GREY, SHADOW_OWN_STEPS, SHADOW_SHORT
  float opaqueDepth;  // 3e38: nothing opaque; of smoke: depth of the last knot
};

struct ShadowKnot {
  float depth;  // ascending
  float tauR;   // optical depth from the light to here
  float tauG;
  float tauB;
};

// Payload of a surface in the list of a texel: by how much the light falls.
struct ShadowNode {
  uint tauRg;         // optical depth of the drop, halves
  uint tauBObject;    // low: the same; high: SHADOW_* of the object, 0 for most
};

struct ShadowPassParams {
  vec4 march;         // x: step of the march through smoke, voxels; y: bound of the error of the transmittance
  ivec4 cells;  // of the face, that knots are written of: x: the first, y: how many, z, w: place of the first in the
                // runs and in the texels
  ivec4 units;  // x: number of the pool's first that is written; y: SHADOW_*: which cells; z: the face's first line in the
                // opaque depth
};

// Of the pass that draws an interlaced map.
struct InterlacedPassParams {
  vec4 lightColour;  // rgb, its largest channel 1
};

struct ShadowCounters {
  uint units;       // of the pool: demand, counted past the capacity
  uint unplaced;    // of it, what found no room
  uint unfinished;  // texels that go on in the next dispatch
  uint boundHit;    // texels whose march was longer than its bound
  uint hidden;      // surfaces in lists that are behind the opaque depth
};

SHARED_END

// Cells whose knots are written.
#define SHADOW_UNPLACED 0  // those that found no room
#define SHADOW_ALL 1
#define SHADOW_UNFINISHED 2  // those that have more surfaces than one dispatch takes

#define SHADOW_OPAQUE_TAU 100.0
#define SHADOW_DARK_TAU 50.0  // what takes more than this is as good as opaque
#define NOTHING_OPAQUE 3e38
#define SHADOW_OWN_STEPS 0x80000000u  // its own steps follow; never of a grey texel
#define SHADOW_GREY 0x40000000u
#define SHADOW_SHORT 0x20000000u
#define SHADOW_KNOTS 0x1fffffffu  // the mask of their count
// Of short knots the count takes SHADOW_SHORT_KNOTS, and above it stands where their depths start, in parts of the last one's.
#define SHADOW_SHORT_KNOTS 0x7fffu
#define SHADOW_START_BIT 15
#define SHADOW_START_MASK 0x3fffu
#define SHADOW_STARTS 16384.0
#define SHADOW_TAU_BITS 15            // of a channel: the square root of its optical depth
#define SHADOW_TAU_MASK 0x7fffu
#define SHADOW_SHORT_TAUS 32767.0
#define SHADOW_SHORT_TAU 32.0         // the largest there is
#define SHADOW_SHORT_DEPTHS 131071.0  // from the start to the last, above the bits of red's

// Linked lists, for comparisons: ids of smoke's nodes, whose words are the end of a stretch and what it takes, as floats;
// and that of opaque surfaces.
#define SHADOW_SMOKE_IDS 0xffffff00u
#define SHADOW_OPAQUE_ID 0xfffffeffu
