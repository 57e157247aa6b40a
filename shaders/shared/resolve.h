// The camera's walk through surfaces and smoke.
#pragma once
#include "shaders/shared/glsl.h"
SHARED_BEGIN

// A ray is walked for every pixel, through its centre, or for every one of its samples where they differ. Rays 0 to
// pixels - 1 are the pixels' (through sample 0 where split); then, for each group (a split pixel), one for each further
// sample. pixelGroups[pixel] is 0 or the number of its group plus 1; pixelGroups[pixels + group] is the group's pixel.

// How far a ray that is walked has come; kept between dispatches, as one may only do so much work.
struct RayState {
  float radianceR;
  float radianceG;
  float radianceB;
  float depth;      // how far the ray has been walked; RAY_FINISHED: to its end
  float throughputR;
  float throughputG;
  float throughputB;
  uint surfaces;    // of its list that it has passed
};

struct ResolveParams {
  vec4 march;      // x: step, voxels; y: throughput below which the rest is not looked at; z: of layers: pixels by
                   // which a normal across the view shifts what is seen through its surface
  ivec4 options;   // x: 1 when this is the first dispatch; y: texels a side that a lookup in a shadow map asks, of
                   // surfaces, and 8 times those of smoke; z: directional lights; w: rays
  vec4 samples01;  // places of the samples in a pixel, [0, 1]^2
  vec4 samples23;
  vec4 ambient;    // rgb: radiance from all around; w: radius of ambient occlusion, m
  ivec4 blocks;    // of smoke, x: pixels a side; y: knots of each at most; z: knots of others before theirs, -1: they
                   // are only counted; w: blocks of that side, before those of single pixels
  ivec4 area;      // x, y, width, height: of layers: pixels that have the rays
};

// A square of pixels of the image, aligned to its side, whose smoke was marched once, along the ray through its middle; behind
// those, of each pixel of the squares that differ much from what is around them. Where
// surfaces stand in the smoke, knots tell how it was on the way: each has a depth, and as halves the radiance of the smoke up
// to there and how much passes it; they are sorted by depth, and between two of them the smoke is as good as homogeneous.
struct SmokeBlock {
  float radianceR;  // of all that was marched
  float radianceG;
  float radianceB;
  float reach;      // depth up to which it tells; SMOKE_ENDLESS: to the smoke's end
  float passedR;    // of what is behind
  float passedG;
  float passedB;
  float start;      // depth at which the smoke begins; SMOKE_ENDLESS: there is none
  float depth;      // to which it was marched so far
  uint refined;     // number of the first of the blocks of its single pixels, row by row, which tell more; 0: none
  uint firstKnot;   // uvec4: depth, radiance.rg, radiance.b passed.r, passed.gb
  uint knots;       // 0: it tells of all the smoke only
};

struct ResolveCounters {
  uint groups;      // pixels that are split, counted past the capacity; of layers: rays that met a surface; of blocks of
                    // smoke: knots, or those that are refined; of all rays: those that are to be walked
  uint unfinished;  // rays that need another dispatch
  uint boundHit;    // walks of light lists that were cut (never silently)
};

SHARED_END

#define NOTHING_SEEN 3e38
#define MAX_SAMPLES 4
#define SMOKE_ENDLESS 3e38
#define RAY_FINISHED 3e38

// Loop iterations after which a ray stops and waits for the next dispatch.
#define RESOLVE_WORK_LIMIT 20000

#ifndef __cplusplus
vec2 samplePosition(ResolveParams params, int number) {
  vec4 two = number < 2 ? params.samples01 : params.samples23;
  return (number & 1) == 0 ? two.xy : two.zw;
}
#endif
