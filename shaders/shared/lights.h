// Lights, as lights/lights_gpu uploads them: directional ones first, then point, then spot lights.
#pragma once
#include "shaders/shared/glsl.h"
SHARED_BEGIN

struct LightData {
  vec4 position;     // world; w: distance beyond which it lights nothing, m
  vec4 direction;    // world, unit, where it shines to; w: cosine of the outer cone (-1: no cone)
  vec4 intensity;    // rgb, W/m^2 or W/sr; w: range^-4 of the KHR window, 0 for none
  vec4 cone;         // x, y: scale and offset of the angular attenuation; z, w: sine and tangent of the outer cone
  ivec4 indices;     // x: LIGHT_*, y: first shadow face or -1, z: faces, w: number of the light in the scene
};

// Of the passes that build and read the light lists.
struct LightPassParams {
  ivec4 cells;   // x, y: cells across and down; z: pixels a cell's side; w: first light of the draw
  ivec4 window;  // x, y: the first cell that has a list; z: how many of a row have one
};

SHARED_END

#define LIGHT_DIRECTIONAL 0
#define LIGHT_POINT 1
#define LIGHT_SPOT 2
