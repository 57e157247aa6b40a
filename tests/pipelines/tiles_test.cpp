// Tiles cover an image once, whatever its shape.
#include "pipelines/tiles.h"

#include <gtest/gtest.h>

namespace sfumato::pipelines {
namespace {

void expectCoversOnce(int width, int height, size_t most) {
  std::vector<int> covered(static_cast<size_t>(width) * static_cast<size_t>(height), 0);
  for (const Tile& tile : tilesOf(width, height, most)) {
    EXPECT_LE(tile.pixels(), most);
    for (int y = tile.y; y < tile.y + tile.height; ++y)
      for (int x = tile.x; x < tile.x + tile.width; ++x)
        ++covered.at(static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x));
  }
  for (const int times : covered) ASSERT_EQ(times, 1) << width << " x " << height << " by " << most;
}

TEST(Tiles, CoverEveryPixelOnce) {
  for (const auto& [width, height] : {std::pair(1, 1), {1, 97}, {97, 1}, {2, 2}, {5, 3}, {64, 48}, {101, 67}})
    for (const size_t most : {1u, 2u, 3u, 16u, 100u, 5000u}) expectCoversOnce(width, height, most);
}

TEST(Tiles, AreOneForACommonImage) {
  for (const auto& [width, height] : {std::pair(1920, 1080), {1280, 720}, {16384, 64}, {1, 16384}, {1, 1}})
    EXPECT_EQ(tilesOf(width, height).size(), 1u) << width << " x " << height;
  EXPECT_EQ(tilesOf(16384, 16384).size(), 128u);
}

TEST(Tiles, ShareNoCellOfTheLightLists) {
  for (const Tile& tile : tilesOf(1001, 333, 2000)) {
    EXPECT_EQ(tile.x % 4, 0);
    EXPECT_EQ(tile.y % 4, 0);
  }
}

}  // namespace
}  // namespace sfumato::pipelines
