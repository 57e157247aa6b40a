// Places of an area tile by tile: what is near each other is looked at at one time, so that caches hold what both need.
#include "shaders/shared/division.glsl"

// The number, row by row, of the place that comes number-th. Tiles at the right and upper edge may be smaller.
uint inTiles(uint number, ivec2 size) {
  const uint SIDE = 8u;
  uint width = uint(size.x);
  uint strip = quotient(number, SIDE * width);
  uint height = min(SIDE, uint(size.y) - SIDE * strip);
  number -= SIDE * width * strip;
  uint tile = quotient(number, SIDE * height);
  ivec2 inTile = placeInRows(number - SIDE * height * tile, int(min(SIDE, width - SIDE * tile)));
  return width * (SIDE * strip + uint(inTile.y)) + SIDE * tile + uint(inTile.x);
}
