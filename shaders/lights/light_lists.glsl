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

uint lightCell(ivec2 pixel, int width) {
  int cellsAcross = (width + LIGHT_CELL_SIDE - 1) / LIGHT_CELL_SIDE;
  return uint((pixel.y / LIGHT_CELL_SIDE) * cellsAcross + pixel.x / LIGHT_CELL_SIDE);
}
