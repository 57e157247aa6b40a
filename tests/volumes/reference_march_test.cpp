#include "volumes/reference_march.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <numbers>

#include "base/random.h"

namespace sfumato::volumes {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double halfVoxel = 0.5 + 1e-9;  // a hair longer, so that rounding adds no step

// Density x + 2 y + 4 z + 1 at the index positions of a 5 x 6 x 7 lattice that starts at (-2, 3, 1) + 2: a
// linear field, which trilinear interpolation gives back exactly.
DensityGrid linearGrid() {
  DensityGrid grid;
  grid.origin = {0, 5, 3};
  grid.size = {5, 6, 7};
  for (int z = 0; z < 7; ++z)
    for (int y = 0; y < 6; ++y)
      for (int x = 0; x < 5; ++x)
        grid.values.push_back(static_cast<float>(1 + x + 2 * (y + 5) + 4 * (z + 3)));
  return grid;
}

double linearField(const glm::dvec3& p) {
  return 1 + p.x + 2 * p.y + 4 * p.z;
}

// n x n x n voxels of density 1 inside a margin of one zero voxel.
DensityGrid onesGrid(int n) {
  DensityGrid grid;
  grid.origin = glm::ivec3(-1);
  grid.size = glm::ivec3(n + 2);
  grid.values.assign(static_cast<size_t>(n + 2) * (n + 2) * (n + 2), 0.f);
  for (int z = 1; z <= n; ++z)
    for (int y = 1; y <= n; ++y)
      for (int x = 1; x <= n; ++x) grid.values[grid.valueIndex(x, y, z)] = 1;
  return grid;
}

Medium medium(DensityGrid grid, const glm::dmat4& worldFromIndex, double scale) {
  Medium m;
  m.grid = std::move(grid);
  m.worldFromIndex = worldFromIndex;
  m.scale = scale;
  return m;
}

// What is the same in all channels.
double grey(const glm::dvec3& v) {
  EXPECT_EQ(v, glm::dvec3(v.x));
  return v.x;
}

glm::dmat4 shearedAndRotated() {
  const glm::dmat4 shear(0.25, 0, 0, 0, 0.1, 0.2, 0, 0, -0.05, 0.15, 0.3, 0, 0, 0, 0, 1);
  const glm::dmat4 turned = glm::rotate(glm::dmat4(1.0), 0.7, glm::normalize(glm::dvec3(1, 2, 3)));
  return glm::translate(glm::dmat4(1.0), glm::dvec3(3, -1, 2)) * turned * shear;
}

TEST(ReferenceMarch, DensityIsTheVoxelAtItsIndexAndTrilinearBetween) {
  const DensityGrid grid = linearGrid();
  EXPECT_EQ(densityAt(grid, {0, 5, 3}), grid.values.front());
  EXPECT_EQ(densityAt(grid, {4, 10, 9}), grid.values.back());
  base::Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const glm::dvec3 p(random.uniform(0, 4), random.uniform(5, 10), random.uniform(3, 9));
    EXPECT_NEAR(densityAt(grid, p), linearField(p), 1e-12);
  }
  // What is not linear: the value at a cell's centre is the mean of its corners.
  DensityGrid cell;
  cell.size = {2, 2, 2};
  cell.values = {1, 2, 3, 5, 8, 13, 21, 34};
  EXPECT_DOUBLE_EQ(densityAt(cell, {0.5, 0.5, 0.5}), 87.0 / 8);
  EXPECT_DOUBLE_EQ(densityAt(cell, {1, 0, 1}), 13);
}

TEST(ReferenceMarch, DensityIsZeroOutsideTheBox) {
  const DensityGrid grid = linearGrid();
  const double tiny = 1e-9;
  for (const glm::dvec3& p :
       {glm::dvec3(-tiny, 6, 4), glm::dvec3(4 + tiny, 6, 4), glm::dvec3(2, 5 - tiny, 4),
        glm::dvec3(2, 10 + tiny, 4), glm::dvec3(2, 6, 3 - tiny), glm::dvec3(2, 6, 9 + tiny),
        glm::dvec3(1e300), glm::dvec3(-1e300), glm::dvec3(std::nan(""), 6, 4)})
    EXPECT_EQ(densityAt(grid, p), 0);
}

TEST(ReferenceMarch, ExtinctionIsDensityTimesScaleInWorldSpace) {
  const Medium m = medium(linearGrid(), shearedAndRotated(), 0.5);
  const glm::dvec3 pIndex(1.25, 7.5, 5.75);
  const glm::dvec3 pWorld(m.worldFromIndex * glm::dvec4(pIndex, 1));
  EXPECT_NEAR(grey(extinctionAt(m, pWorld)), 0.5 * linearField(pIndex), 1e-11);
}

TEST(ReferenceMarch, RaysAreClippedToTheBox) {
  const Medium m = medium(linearGrid(), glm::translate(glm::dmat4(1.0), glm::dvec3(10, 0, 0)), 1);
  double tMin = 0;
  double tMax = 100;
  ASSERT_TRUE(clipToMedium(m, {0, 6, 4}, {2, 0, 0}, tMin, tMax));  // world box x in [10, 14]
  EXPECT_DOUBLE_EQ(tMin, 5);
  EXPECT_DOUBLE_EQ(tMax, 7);

  tMin = 0;
  tMax = std::numeric_limits<double>::infinity();
  ASSERT_TRUE(clipToMedium(m, {12, 6, 4}, {0, -1, 0}, tMin, tMax));  // from inside, downwards to y = 5
  EXPECT_DOUBLE_EQ(tMin, 0);
  EXPECT_DOUBLE_EQ(tMax, 1);

  tMin = 0;
  tMax = 4;
  EXPECT_FALSE(clipToMedium(m, {0, 6, 4}, {2, 0, 0}, tMin, tMax)) << "ends before the box";
  tMin = 0;
  tMax = 100;
  EXPECT_FALSE(clipToMedium(m, {0, 6, 4}, {-1, 0, 0}, tMin, tMax)) << "behind";
  tMin = 0;
  tMax = 100;
  EXPECT_FALSE(clipToMedium(m, {0, 4, 4}, {1, 0, 0}, tMin, tMax)) << "parallel and beside";
}

TEST(ReferenceMarch, AMediumFlattenedToNothingIsNowhere) {
  const Medium flat = medium(onesGrid(4), glm::scale(glm::dmat4(1.0), glm::dvec3(1, 0, 1)), 1);
  double tMin = 0;
  double tMax = 100;
  EXPECT_FALSE(clipToMedium(flat, {0, -5, 0}, {0, 1, 0}, tMin, tMax));
  EXPECT_EQ(grey(opticalDepth({&flat, 1}, {0, -5, 0}, {0, 5, 0}, 0.5)), 0);
}

// Along an axis the profile is a trapezoid: two ramps of one voxel at the faces and n - 1 voxels of 1
// between, n in all. The midpoint rule is exact since half voxels end at the kinks.
TEST(ReferenceMarch, OpticalDepthOfASlabAlongAnAxis) {
  const int n = 8;
  const double voxel = 0.25;
  const Medium m = medium(onesGrid(n), glm::scale(glm::dmat4(1.0), glm::dvec3(voxel)), 3);
  const double expected = 3 * n * voxel;
  EXPECT_NEAR(grey(opticalDepth({&m, 1}, {-10, 1, 1}, {10, 1, 1}, halfVoxel)), expected, 1e-12);
  EXPECT_NEAR(grey(opticalDepth({&m, 1}, {1, 10, 1}, {1, -10, 1}, halfVoxel)), expected, 1e-12);
  // From the middle (index 3.5) outwards: half of it.
  EXPECT_NEAR(grey(opticalDepth({&m, 1}, {1, 1, 3.5 * voxel}, {1, 1, 10}, halfVoxel)), expected / 2, 1e-12);
}

// A slanted ray meets the same trapezoid, stretched by 1 / cosine, but steps no longer end at its kinks; the
// error is of the order of step^2 over the four kinks.
TEST(ReferenceMarch, OpticalDepthOfASlabAtASlant) {
  const int n = 16;
  const Medium m = medium(onesGrid(n), glm::dmat4(1.0), 1);
  const glm::dvec3 middle(7.5);
  const glm::dvec3 direction = glm::normalize(glm::dvec3(1, 0.25, 0.125));
  const double expected = n / direction.x;
  const glm::dvec3 from = middle - 30.0 * direction;
  const glm::dvec3 to = middle + 30.0 * direction;
  EXPECT_NEAR(grey(opticalDepth({&m, 1}, from, to, 0.5)), expected, 0.5 * 0.5 / 2);
  EXPECT_NEAR(grey(opticalDepth({&m, 1}, from, to, 0.01)), expected, 0.01 * 0.01 / 2);
}

// On a line through a linear field the mean is the value in the middle, and the midpoint rule is exact.
TEST(ReferenceMarch, OpticalDepthInAShearedAndRotatedGrid) {
  const Medium m = medium(linearGrid(), shearedAndRotated(), 0.125);
  const glm::dvec3 fromIndex(0.5, 5.25, 8.5);
  const glm::dvec3 toIndex(3.75, 9.5, 3.5);
  const glm::dvec3 from(m.worldFromIndex * glm::dvec4(fromIndex, 1));
  const glm::dvec3 to(m.worldFromIndex * glm::dvec4(toIndex, 1));
  const double expected = 0.125 * glm::distance(from, to) * linearField((fromIndex + toIndex) / 2.0);
  EXPECT_NEAR(grey(opticalDepth({&m, 1}, from, to, 0.5)), expected, 1e-12 * expected);
  EXPECT_NEAR(grey(opticalDepth({&m, 1}, to, from, 7)), expected, 1e-12 * expected);
}

TEST(ReferenceMarch, OpticalDepthsAdd) {
  const std::vector<Medium> media = {
      medium(onesGrid(4), glm::dmat4(1.0), 1), medium(onesGrid(8), glm::dmat4(1.0), 2),
      medium(onesGrid(4), glm::translate(glm::dmat4(1.0), glm::dvec3(0, 50, 0)), 100)};
  EXPECT_NEAR(grey(opticalDepth(media, {-9, 1, 1}, {19, 1, 1}, halfVoxel)), 4 + 2 * 8, 1e-12);
  EXPECT_EQ(grey(opticalDepth(media, {1, 1, 1}, {1, 1, 1}, 0.5)), 0);
  EXPECT_EQ(grey(opticalDepth({}, {-9, 1, 1}, {19, 1, 1}, 0.5)), 0);
}

TEST(ReferenceMarch, ColoursMultiplyTheExtinctionOfEachMedium) {
  std::vector<Medium> media = {medium(onesGrid(4), glm::dmat4(1.0), 1),
                               medium(onesGrid(8), glm::dmat4(1.0), 2)};
  media[0].extinctionColour = {1, 0.5, 0};
  media[1].extinctionColour = {0.25, 0, 3};
  EXPECT_EQ(extinctionAt(media[1], {1, 1, 1}), glm::dvec3(0.5, 0, 6));
  const glm::dvec3 depth = opticalDepth(media, {-9, 1, 1}, {19, 1, 1}, halfVoxel);
  EXPECT_NEAR(glm::distance(depth, {4 + 4, 2, 48}), 0, 1e-12);
}

// Simpson's rule over the cosine; so many intervals leave an error of about 1e-11 at g = 0.95.
double integrateOverCosine(double g, bool timesCosine) {
  const int n = 400000;
  double sum = 0;
  for (int i = 0; i <= n; ++i) {
    const double cosine = -1 + 2.0 * i / n;
    const double weight = i == 0 || i == n ? 1 : i % 2 == 1 ? 4 : 2;
    sum += weight * phaseHenyeyGreenstein(cosine, g) * (timesCosine ? cosine : 1);
  }
  return 2 * pi * sum * (2.0 / n) / 3;
}

TEST(ReferenceMarch, PhaseIntegratesToOneAndItsMeanCosineIsG) {
  for (const double g : {-0.9, -0.5, 0.0, 0.3, 0.6, 0.95}) {
    EXPECT_NEAR(integrateOverCosine(g, false), 1, 1e-9) << "g = " << g;
    EXPECT_NEAR(integrateOverCosine(g, true), g, 1e-9) << "g = " << g;
  }
}

TEST(ReferenceMarch, PhaseValues) {
  EXPECT_DOUBLE_EQ(phaseHenyeyGreenstein(0.3, 0), 1 / (4 * pi));
  EXPECT_DOUBLE_EQ(phaseHenyeyGreenstein(1, 0.5), 0.75 / (4 * pi * 0.125));   // forwards: (1 - g)^3
  EXPECT_DOUBLE_EQ(phaseHenyeyGreenstein(-1, 0.5), 0.75 / (4 * pi * 3.375));  // backwards: (1 + g)^3
}

}  // namespace
}  // namespace sfumato::volumes
