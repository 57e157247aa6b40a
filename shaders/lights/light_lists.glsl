// The light lists, for readers: which lights reach a depth in a pixel.
#include "shaders/lights/light.glsl"
#include "shaders/shared/lists.h"

layout(std430, binding = STORAGE_LIGHT_CELL_HEADS) readonly buffer LightCellHeads {
  uint lightCellHeads[];
};
layout(std430, binding = STORAGE_LIGHT_CELL_LINKS) readonly buffer LightCellLinks {
  ListLink lightCellLinks[];  // depth: front depth, id: light
};
layout(std430, binding = STORAGE_LIGHT_CELL_PAYLOADS) readonly buffer LightCellBacks {
  float lightCellBacks[];  // back depth
};

const int LIGHT_CELL_SIDE = 4;  // pixels

// The cell of a pixel of the image; `window`: the pixels that have lists (ViewParams).
uint lightCell(ivec2 pixel, ivec4 window) {
  ivec2 first = window.xy / LIGHT_CELL_SIDE;
  int cellsAcross = (window.x + window.z + LIGHT_CELL_SIDE - 1) / LIGHT_CELL_SIDE - first.x;
  ivec2 cell = pixel / LIGHT_CELL_SIDE - first;
  return uint(cell.y * cellsAcross + cell.x);
}
