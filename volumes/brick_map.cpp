#include "volumes/brick_map.h"

#include <algorithm>
#include <array>
#include <limits>

namespace sfumato::volumes {
namespace {

constexpr uint32_t farthest = std::numeric_limits<uint32_t>::max() / 2;

// The bricks from low to high that have a voxel among theirs: it is a corner of the cells on both sides of
// it.
struct Touched {
  int low, high;
  bool operator==(const Touched&) const = default;
};

Touched touched(int voxel, int side) {
  return {std::max(voxel - 1, 0) / side, voxel / side};
}

void fillAround(BrickMap& map, const glm::ivec3& first, std::span<const float> row) {
  const Touched alongY = touched(first.y, map.side), alongZ = touched(first.z, map.side);
  Touched done{-1, -1};
  int x = first.x - 1;
  for (const float value : row) {
    ++x;
    if (value == 0) continue;
    const Touched alongX = touched(x, map.side);
    if (alongX == done) continue;
    done = alongX;
    for (int k = alongZ.low; k <= alongZ.high; ++k)
      for (int j = alongY.low; j <= alongY.high; ++j)
        for (int i = alongX.low; i <= alongX.high; ++i) map.distance[map.place({i, j, k})] = 0;
  }
}

// Each brick learns from the half of its neighbours that come before it in memory. There is a margin of one.
void learnForward(std::vector<uint32_t>& distance, const glm::ivec3& size) {
  const std::ptrdiff_t row = size.x, layer = row * size.y;
  std::array<std::ptrdiff_t, 13> before{};
  for (int i = 0; i < 13; ++i)
    before[static_cast<size_t>(i)] = (i % 3 - 1) + (i / 3 % 3 - 1) * row + (i / 9 - 1) * layer;
  for (int z = 1; z < size.z - 1; ++z)
    for (int y = 1; y < size.y - 1; ++y) {
      uint32_t* brick = distance.data() + y * row + z * layer;
      for (int x = 1; x < size.x - 1; ++x)
        for (const std::ptrdiff_t offset : before) brick[x] = std::min(brick[x], brick[x + offset] + 1);
    }
}

// Distances from the zeros, by two passes to and fro (Rosenfeld and Pfaltz 1966).
void spreadDistances(std::vector<uint32_t>& distance, const glm::ivec3& size) {
  learnForward(distance, size);
  std::reverse(distance.begin(), distance.end());
  learnForward(distance, size);
  std::reverse(distance.begin(), distance.end());
}

}  // namespace

glm::ivec3 brickCount(const DensityGrid& grid, int side) {
  return (grid.size + side - 1) / side;
}

BrickMap mapBricks(const DensityGrid& grid, int side) {
  BrickMap map{.side = side, .count = brickCount(grid, side)};
  const glm::ivec3 size = map.count + 2;
  map.distance.assign(map.place(map.count) + 1, farthest);
  forEachRow(grid, [&](const glm::ivec3& first, std::span<const float> row) { fillAround(map, first, row); });
  map.filled = static_cast<size_t>(std::count(map.distance.begin(), map.distance.end(), 0u));
  spreadDistances(map.distance, size);
  return map;
}

}  // namespace sfumato::volumes
