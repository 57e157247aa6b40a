// Grids of values, by number: a 3D texture each, dense or of bricks, and one map for all that says which bricks hold
// anything. GRID_COUNT is how many there are; bit g of GRID_BRICKS is set where grid g is in bricks, of GRID_BRICK_SIDE
// cells a side. A brick is stored with all voxels around its cells, so that its border is filtered like its middle.
#include "shaders/shared/bindings.h"
#include "shaders/shared/grids.h"

layout(std140, binding = UNIFORM_GRIDS) uniform Grids {
  GridData grids[GRID_COUNT];
};
layout(binding = TEXTURE_BRICK_MAP) uniform usampler3D brickMap;
layout(binding = TEXTURE_GRIDS) uniform sampler3D gridValues[GRID_COUNT];

// The value of grid g at p, in the grid's own coordinates and inside its box.
float sampleGrid(int g, vec3 p) {
#if GRID_BRICKS != 0
  if ((GRID_BRICKS >> g & 1) != 0) {
    vec3 brick = floor(p);
    uint entry = texelFetch(brickMap, ivec3(brick), 0).r;
    if (entry < BRICK_FILLED) return 0.0;
    const uint AXIS = (1u << BRICK_AXIS_BITS) - 1u;
    vec3 place = vec3(entry & AXIS, entry >> BRICK_AXIS_BITS & AXIS, entry >> 2 * BRICK_AXIS_BITS & AXIS);
    vec3 texel = place * float(GRID_BRICK_SIDE + 1) + (p - brick) * float(GRID_BRICK_SIDE) + 0.5;
    return textureLod(gridValues[g], texel / vec3(textureSize(gridValues[g], 0)), 0.0).r;
  }
#endif
  return textureLod(gridValues[g], p, 0.0).r;
}

// What the bricks of grid g tell of the line start + t * rate, in the grid's coordinates, at a t: up to which other one it
// meets nothing but zeros (x; at least the given one), or stays in a brick that is filled (y; likewise).
vec2 emptyFilledUntil(int g, vec3 start, vec3 rate, float t) {
  vec3 bricksRate = rate * grids[g].bricksScale.xyz;
  bricksRate = mix(bricksRate, vec3(1e-20), lessThan(abs(bricksRate), vec3(1e-20)));
  vec3 p = (start + t * rate) * grids[g].bricksScale.xyz + grids[g].bricksFirst.xyz;
  vec3 brick = floor(p);
  uint entry = texelFetch(brickMap, ivec3(brick), 0).r;
  bool filled = entry >= BRICK_FILLED;
  float reach = filled ? 1.0 : float(entry);
  vec3 faces = mix(brick + 1.0 - reach, brick + reach, greaterThan(bricksRate, vec3(0.0)));
  vec3 further = (faces - p) / bricksRate;
  float until = t + max(min(further.x, min(further.y, further.z)), 0.0);
  return filled ? vec2(t, until) : vec2(until, t);
}
