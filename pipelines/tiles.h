// The parts of an image that are drawn one after the other, so that memory does not grow with the image.
#pragma once

#include <array>
#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

namespace sfumato::pipelines {

// A rectangle of an image's pixels, at least one of them; rows count from the bottom, as GL has them.
struct Tile {
  int x = 0;
  int y = 0;
  int width = 1;
  int height = 1;

  size_t pixels() const { return static_cast<size_t>(width) * static_cast<size_t>(height); }
  glm::ivec4 corners() const { return {x, y, width, height}; }
  // Where the tile's pixel of a number, row by row, is in an image whose rows count from the top.
  glm::ivec2 placeOf(size_t number, int imageHeight) const {
    const auto across = static_cast<size_t>(width);
    return {x + static_cast<int>(number % across), imageHeight - 1 - y - static_cast<int>(number / across)};
  }
};

// Most pixels of a tile: an image of 1920x1080 is one. With four samples a pixel its G-buffer takes 320 MiB.
constexpr size_t tilePixels = size_t{1} << 21;

// A tile of more than one pixel, cut across its longer side; at a multiple of 4 pixels, so that both parts
// share no cell of the light lists, unless it is 4 pixels long or less.
std::array<Tile, 2> halves(const Tile& tile);

// Tiles that cover an image, each pixel once, by halving until none has more than `most` pixels. They depend
// on nothing else: what a device can hold changes no tile.
std::vector<Tile> tilesOf(int width, int height, size_t most = tilePixels);

}  // namespace sfumato::pipelines
