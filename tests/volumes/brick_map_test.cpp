// Which bricks hold anything, and how far away the next one is, against a look at every voxel and brick.
#include "volumes/brick_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "base/random.h"
#include "tests/volumes/sparse_grids.h"

namespace sfumato::volumes {
namespace {

using glm::ivec3;

// Whether one of the voxels at the corners of the brick's cells is not 0.
bool isFilled(const DensityGrid& grid, const ivec3& brick, int side) {
  const ivec3 low = brick * side, high = glm::min(low + side, grid.size - 1);
  for (int z = low.z; z <= high.z; ++z)
    for (int y = low.y; y <= high.y; ++y)
      for (int x = low.x; x <= high.x; ++x)
        if (grid.value({x, y, z}) != 0) return true;
  return false;
}

template <typename Visit>
void forEachBrick(const BrickMap& map, const Visit& visit) {
  for (int z = 0; z < map.count.z; ++z)
    for (int y = 0; y < map.count.y; ++y)
      for (int x = 0; x < map.count.x; ++x) visit(ivec3(x, y, z));
}

void expectRight(const DensityGrid& grid, int side) {
  const BrickMap map = mapBricks(grid, side);
  ASSERT_EQ(map.count, (grid.size + side - 1) / side);
  std::vector<ivec3> filled;
  forEachBrick(map, [&](const ivec3& brick) {
    if (isFilled(grid, brick, side)) filled.push_back(brick);
  });
  EXPECT_EQ(map.filled, filled.size());
  long wrong = 0;
  forEachBrick(map, [&](const ivec3& brick) {
    int nearest = std::numeric_limits<int>::max();
    for (const ivec3& other : filled) {
      const ivec3 away = glm::abs(other - brick);
      nearest = std::min(nearest, std::max({away.x, away.y, away.z}));
    }
    wrong += map.distance[map.place(brick)] != static_cast<uint32_t>(nearest);
  });
  EXPECT_EQ(wrong, 0);
}

TEST(BrickMap, KnowsWhatIsFilledAndHowFarTheRestIsFromIt) {
  for (const int side : {8, 16, 32})
    for (const int voxels : {1, 3, 40}) {
      SCOPED_TRACE(testing::Message() << side << " cells a side, " << voxels << " voxels");
      const DensityGrid grid = tests::scatteredVoxels({83, 50, 67}, voxels, 7);
      expectRight(grid, side);
      expectRight(tests::inBricks(grid), side);
    }
}

TEST(BrickMap, AVoxelOnABorderFillsTheBricksOnBothSides) {
  DensityGrid grid = tests::scatteredVoxels({40, 40, 40}, 0, 1);
  grid.values[grid.valueIndex(16, 16, 16)] = 1;
  EXPECT_EQ(mapBricks(grid, 8).filled, 8u);
  grid.values[grid.valueIndex(16, 16, 16)] = 0;
  grid.values[grid.valueIndex(17, 17, 17)] = 1;
  EXPECT_EQ(mapBricks(grid, 8).filled, 1u);
}

TEST(BrickMap, AnEmptyGridIsFarFromEverything) {
  const BrickMap map = mapBricks(tests::scatteredVoxels({20, 30, 10}, 0, 1), 8);
  EXPECT_EQ(map.filled, 0u);
  EXPECT_GT(*std::min_element(map.distance.begin(), map.distance.end()), 1000u);
}

TEST(DensityGrid, InBricksHoldsTheSameValues) {
  const DensityGrid dense = tests::scatteredVoxels({83, 50, 67}, 200, 3);
  const DensityGrid sparse = tests::inBricks(dense);
  EXPECT_TRUE(dense.dense());
  EXPECT_FALSE(sparse.dense());
  EXPECT_LT(sparse.bytes(), dense.bytes());
  long wrong = 0;
  for (int z = 0; z < dense.size.z; ++z)
    for (int y = 0; y < dense.size.y; ++y)
      for (int x = 0; x < dense.size.x; ++x) wrong += dense.value({x, y, z}) != sparse.value({x, y, z});
  EXPECT_EQ(wrong, 0);
}

TEST(DensityGrid, RowsHoldEveryValueOnce) {
  const DensityGrid dense = tests::scatteredVoxels({21, 34, 13}, 100, 5);
  for (const DensityGrid& grid : {dense, tests::inBricks(dense)}) {
    size_t found = 0;
    forEachRow(grid, [&](ivec3 voxel, std::span<const float> row) {
      for (const float value : row) {
        if (value != 0) {
          EXPECT_EQ(value, dense.value(voxel));
          ++found;
        }
        ++voxel.x;
      }
    });
    EXPECT_EQ(found, static_cast<size_t>(std::count_if(dense.values.begin(), dense.values.end(),
                                                       [](float value) { return value != 0; })));
  }
}

}  // namespace
}  // namespace sfumato::volumes
