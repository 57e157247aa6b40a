#include "volumes/procedural_smoke.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"

namespace sfumato::volumes {
namespace {

// Density times volume.
double mass(const DensityGrid& grid) {
  double sum = 0;
  for (const float value : grid.values) sum += value;
  return sum * std::pow(voxelSize(grid.worldFromIndex), 3);
}

template <typename Visit>
void forEachVoxel(const DensityGrid& grid, const Visit& visit) {
  for (int z = 0; z < grid.size.z; ++z)
    for (int y = 0; y < grid.size.y; ++y)
      for (int x = 0; x < grid.size.x; ++x)
        visit(glm::dvec3(grid.worldFromIndex * glm::dvec4(grid.origin + glm::ivec3(x, y, z), 1)),
              grid.values[grid.valueIndex(x, y, z)]);
}

TEST(ProceduralSmoke, IsTheSameBitsOnEveryRunAndOnOneThread) {
  const DensityGrid first = makePlume(40, 2, 7);
  EXPECT_EQ(makePlume(40, 2, 7).values, first.values);
  const tbb::global_control oneThread(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(makePlume(40, 2, 7).values, first.values);
}

TEST(ProceduralSmoke, DiffersFromSeedToSeed) {
  EXPECT_NE(makePlume(40, 2, 7).values, makePlume(40, 2, 8).values);
}

TEST(ProceduralSmoke, StandsOnTheOriginAndFillsItsHeight) {
  for (const double height : {1.0, 2.0, 6.0}) {
    const DensityGrid grid = makePlume(48, height, 1);
    SCOPED_TRACE(height);
    EXPECT_EQ(grid.name, "density");
    EXPECT_NEAR(voxelSize(grid.worldFromIndex), height / 48, 1e-15);
    glm::dvec3 low(1e9), high(-1e9), footSum(0);
    double footMass = 0;
    forEachVoxel(grid, [&](const glm::dvec3& p, float density) {
      if (density == 0) return;
      low = glm::min(low, p);
      high = glm::max(high, p);
      if (p.y > 0.05 * height) return;
      footSum += static_cast<double>(density) * p;
      footMass += density;
    });
    EXPECT_EQ(low.y, 0);
    EXPECT_GT(high.y, 0.75 * height);
    EXPECT_LE(high.y, height);
    EXPECT_GT(high.x - low.x, 0.6);
    EXPECT_LT(high.x - low.x, 1.3);
    EXPECT_NEAR(footSum.x / footMass, 0, 0.1);
    EXPECT_NEAR(footSum.z / footMass, 0, 0.1);
  }
}

TEST(ProceduralSmoke, HoldsDensitiesUpToOneAndAnEmptyMargin) {
  const DensityGrid grid = makePlume(64, 2, 3);
  ASSERT_EQ(grid.values.size(), grid.valueIndex(0, 0, grid.size.z));
  float highest = 0;
  for (int z = 0; z < grid.size.z; ++z)
    for (int y = 0; y < grid.size.y; ++y)
      for (int x = 0; x < grid.size.x; ++x) {
        const float value = grid.values[grid.valueIndex(x, y, z)];
        ASSERT_TRUE(value >= 0 && value <= 1);
        highest = std::max(highest, value);
        if (x == 0 || y == 0 || z == 0 || x == grid.size.x - 1 || y == grid.size.y - 1 ||
            z == grid.size.z - 1) {
          ASSERT_EQ(value, 0);
        }
      }
  EXPECT_GT(highest, 0.8f);
}

TEST(ProceduralSmoke, IsTheSamePlumeAtEveryResolution) {
  const double fine = mass(makePlume(96, 2, 5));
  EXPECT_NEAR(mass(makePlume(48, 2, 5)) / fine, 1, 0.05);
}

// A blurred cylinder is all said by the mean density at each height and distance from the axis; of smoke that
// says less than half of the variance.
TEST(ProceduralSmoke, IsNoBlurredCylinder) {
  const DensityGrid grid = makePlume(64, 2, 1);
  struct Ring {
    double sum = 0, squares = 0, count = 0;
  };
  std::map<std::pair<int, int>, Ring> rings;
  forEachVoxel(grid, [&](const glm::dvec3& p, float density) {
    Ring& ring = rings[{static_cast<int>(p.y / 0.05), static_cast<int>(std::hypot(p.x, p.z) / 0.05)}];
    ring.sum += density;
    ring.squares += static_cast<double>(density) * density;
    ring.count += 1;
  });
  double within = 0, sum = 0, squares = 0, count = 0;
  for (const auto& [place, ring] : rings) {
    within += ring.squares - ring.sum * ring.sum / ring.count;
    sum += ring.sum;
    squares += ring.squares;
    count += ring.count;
  }
  const double total = squares - sum * sum / count;
  EXPECT_GT(within / total, 0.5);
}

TEST(ProceduralSmoke, RefusesSizesItIsNotMadeFor) {
  EXPECT_THROW(makePlume(7, 2, 1), base::Error);
  EXPECT_THROW(makePlume(513, 2, 1), base::Error);
  EXPECT_THROW(makePlume(64, 0.5, 1), base::Error);
  EXPECT_THROW(makePlume(64, std::nan(""), 1), base::Error);
}

}  // namespace
}  // namespace sfumato::volumes
