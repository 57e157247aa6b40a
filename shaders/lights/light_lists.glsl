// The light lists, for readers: which lights reach a depth in a pixel. WALK_LISTS is defined when they are linked lists,
// for comparisons.
#include "shaders/lights/light.glsl"
#include "shaders/shared/lists.h"

layout(binding = TEXTURE_LIGHT_CELL_RUNS) uniform usamplerBuffer lightCellRuns;    // ListRun
layout(binding = TEXTURE_LIGHT_CELL_KEYS) uniform usamplerBuffer lightCellKeys;    // ListKey: front depth, light and back

const int LIGHT_CELL_SIDE = 4;  // pixels

// The cell of a pixel of the image; `window`: the pixels that have lists (ViewParams).
uint lightCell(ivec2 pixel, ivec4 window) {
  ivec2 first = window.xy / LIGHT_CELL_SIDE;
  int cellsAcross = (window.x + window.z + LIGHT_CELL_SIDE - 1) / LIGHT_CELL_SIDE - first.x;
  ivec2 cell = pixel / LIGHT_CELL_SIDE - first;
  return uint(cell.y * cellsAcross + cell.x);
}

ListRun lightRun(uint cell) {
  uvec2 run = texelFetch(lightCellRuns, int(cell)).xy;
#ifdef WALK_LISTS
  run.y = 0x3fffffffu;  // its end is seen when one gets there
#endif
  return ListRun(run.x, run.y);
}

// What a cell's list says of a light.
struct ListedLight {
  uint light;
  float front;  // depths between which it may reach something in the cell
  float back;
};

ListedLight listedLight(uint node) {
#ifdef WALK_LISTS
  if (node == 0u) return ListedLight(0u, 3e38, -3e38);
#endif
  uvec2 key = texelFetch(lightCellKeys, int(node)).xy;
  return ListedLight(key.y >> LIGHT_NUMBER_SHIFT, uintBitsToFloat(key.x), uintBitsToFloat(key.y << LIGHT_NUMBER_SHIFT));
}

#ifdef WALK_LISTS
uint lightNode = 0u;

// Light i of a list, asked for one after the other from 0 on.
ListedLight walkedLight(ListRun run, uint i) {
  lightNode = i == 0u ? run.first : texelFetch(lightCellKeys, int(lightNode)).z;
  return listedLight(lightNode);
}
#endif
