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

// Of the passes that build the light lists.
struct LightPassParams {
  ivec4 cells;   // x, y: cells across and down; z: pixels a cell's side; w: first light that is not directional
  ivec4 window;  // x, y: the first cell that has a list; z, w: how many of a row and of a column have one
};

SHARED_END

#define LIGHT_DIRECTIONAL 0
#define LIGHT_POINT 1
#define LIGHT_SPOT 2

// The id of a light's node in a cell: the number of the light, and its back depth there as the upper half of a float.
#define LIGHT_NUMBER_SHIFT 16
#define LIGHT_MOST 65536

// Work of one dispatch that builds the lists by computing: tiles of cells, and lights that a group goes through.
#define LIGHT_TILE_SIDE 8
#define LIGHTS_OF_A_GROUP 4096
