#include "pipelines/tiles.h"

namespace sfumato::pipelines {
namespace {

// Where `length` pixels from `start` on are cut, counted from `start`.
int middleOf(int start, int length) {
  const int middle = length / 2;
  const int aligned = (start + middle + 3) / 4 * 4 - start;
  return aligned < length ? aligned : middle;
}

void addTiles(const Tile& tile, size_t most, std::vector<Tile>& tiles) {
  if (tile.pixels() <= most) {
    tiles.push_back(tile);
    return;
  }
  for (const Tile& half : halves(tile)) addTiles(half, most, tiles);
}

}  // namespace

std::array<Tile, 2> halves(const Tile& tile) {
  Tile first = tile;
  Tile second = tile;
  if (tile.width >= tile.height) {
    first.width = middleOf(tile.x, tile.width);
    second.x += first.width;
    second.width -= first.width;
  } else {
    first.height = middleOf(tile.y, tile.height);
    second.y += first.height;
    second.height -= first.height;
  }
  return {first, second};
}

std::vector<Tile> tilesOf(int width, int height, size_t most) {
  std::vector<Tile> tiles;
  addTiles({0, 0, width, height}, most, tiles);
  return tiles;
}

}  // namespace sfumato::pipelines
