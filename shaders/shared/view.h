// What a scene is looked at from: the camera, or one face of a light's shadow map.
#pragma once
#include "shaders/shared/glsl.h"
SHARED_BEGIN

// View space looks along -Z; depth is the distance along -Z, in metres.
struct ViewParams {
  mat4 viewFromWorld;
  mat4 worldFromView;
  mat4 clipFromView;
  vec4 halfExtent;   // xy: of the image at depth 1 (perspective) or anywhere (orthographic), m; z: 1 for orthographic
  vec4 depthRange;   // x: near, y: far (3e38 for none); z: a power of two, times which every depth that is seen is below 1
  ivec4 size;        // x, y: width, height in pixels or texels; z: what to add for their number in the lists or
              // runs that are written; w: first row that a compute pass works on
  // Of the camera, whose image may be drawn in parts; pixels, rows from the bottom.
  ivec4 tile;    // x, y: the one at the G-buffer's lower left; z, w: size of the G-buffer
  ivec4 window;  // x, y, width, height: those that have lists, in this order; they lie in the tile
};

SHARED_END
