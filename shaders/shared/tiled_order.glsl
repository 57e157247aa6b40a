// Places of an area tile by tile: what is near each other is looked at at one time, so that caches hold what both need.
#include "shaders/shared/division.glsl"

// The number, row by row, of the place that comes number-th. Tiles at the right and upper edge may be smaller.
uint inTiles(uint number, ivec2 size) {
  const uint ACROSS = 4u;  // so that eight in a row, which drivers run together, are near each other as well
  const uint LINES = 32u;
  uint width = uint(size.x);
  uint strip = quotient(number, LINES * width);
  uint height = min(LINES, uint(size.y) - LINES * strip);
  number -= LINES * width * strip;
  uint tile = quotient(number, ACROSS * height);
  ivec2 inTile = placeInRows(number - ACROSS * height * tile, int(min(ACROSS, width - ACROSS * tile)));
  return width * (LINES * strip + uint(inTile.y)) + ACROSS * tile + uint(inTile.x);
}
