// Post-processing of a frame for a screen. Images have their rows from the top.
#pragma once
#include "shaders/shared/glsl.h"
SHARED_BEGIN

struct PostParams {
  ivec4 sizes;  // xy: of the image that is read; zw: of the one that is written
  ivec4 step;   // x: how many texels a side of the larger image are one of the smaller; yz: direction of the blur
  vec4 light;   // x: luminance that the screen shows as about 1; y: luminance that does not glow; z: what is added,
                // times this
};

SHARED_END

#define BLOOM_BLUR_RADIUS 6  // texels, on either side
#define BLOOM_BLUR_SIGMA 2.5
