// Grids of values, as volumes/grids_gpu uploads them.
#pragma once
#include "shaders/shared/glsl.h"
SHARED_BEGIN

// The coordinates of a dense grid are those of its texture, those of a grid in bricks count bricks of the map.
struct GridData {
  mat4 gridFromWorld;
  vec4 boxMin;       // where its values stand, from the first to the last voxel
  vec4 boxMax;
  vec4 bricksScale;  // xyz: bricks of the map for one unit
  vec4 bricksFirst;  // xyz: the map's coordinates of the grid's 0
};

SHARED_END

// What the map says of a brick: FILLED and, for a grid in bricks, which one of its texture it is, 10 bits an axis; or how
// many bricks away, along the farthest axis, the next filled one is.
#define BRICK_FILLED 0x80000000u
#define BRICK_AXIS_BITS 10
