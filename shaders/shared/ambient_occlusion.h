// How much of the ambient light gets to what a G-buffer shows: see pipelines/ambient_occlusion_gpu.h.
#pragma once
#include "shaders/shared/glsl.h"
SHARED_BEGIN

#define OCCLUSION_SAMPLES 16
#define OCCLUSION_BLUR_MOST 30  // results that the blur reaches to each side, at most

struct OcclusionParams {
  vec4 offsets[OCCLUSION_SAMPLES];  // xyz: points of the unit ball
  ivec4 size;      // x, y: results across and up; z: pixels a side for which there is one; w: how far the blur reaches
  ivec4 along;     // x, y: the direction of the blur, one of them 1
  vec4 distances;  // x: radius, m; y: delta of the blur's weights, radii; z: how far it reaches, radii
};

SHARED_END
