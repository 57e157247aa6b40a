// How many pixels a ray through smoke stands for.
#include <gtest/gtest.h>

#include "pipelines/smoke_rays.h"

namespace sfumato::pipelines {
namespace {

// Pixels of 1/100 m at depth 1; smoke between depths 1 and 3.
constexpr int height = 200;

scene::Camera camera(bool orthographic = false) {
  scene::Camera camera;
  camera.orthographic = orthographic;
  camera.yMagnitude = 1;
  camera.yfov = glm::radians(90.0);
  return camera;
}

volumes::MediumExtent smoke(double voxel, double nearest = 1, double farthest = 3) {
  glm::dmat4 worldFromUnit(1);
  worldFromUnit[2][2] = farthest - nearest;
  worldFromUnit[3] = glm::dvec4(-0.5, -0.5, -farthest, 1);
  return {worldFromUnit, voxel};
}

int sideOf(std::vector<volumes::MediumExtent> media, double spacing, bool orthographic = false,
           bool half = false) {
  Quality quality;
  quality.smokeRaySpacing = spacing;
  quality.halfResolutionSmoke = half;
  return smokeBlockSide(media, camera(orthographic), height, quality);
}

TEST(SmokeBlockSide, IsWhatVoxelsCoverWhereTheyAreFarthest) {
  EXPECT_EQ(sideOf({smoke(0.0599)}, 1), 1);
  EXPECT_EQ(sideOf({smoke(0.0601)}, 1), 2);
  EXPECT_EQ(sideOf({smoke(0.1199)}, 1), 2);
  EXPECT_EQ(sideOf({smoke(0.1201)}, 1), 4);
  EXPECT_EQ(sideOf({smoke(5)}, 1), 4);
  EXPECT_EQ(sideOf({smoke(0.0601)}, 2), 4);
  EXPECT_EQ(sideOf({smoke(0.0201)}, 1, true), 2);
}

TEST(SmokeBlockSide, IsThatOfTheFinestMedium) {
  EXPECT_EQ(sideOf({smoke(5), smoke(0.0601)}, 1), 2);
  EXPECT_EQ(sideOf({smoke(5), smoke(0.01)}, 1), 1);
}

TEST(SmokeBlockSide, IsOneWhereNothingOrNoSmokeAllowsMore) {
  EXPECT_EQ(sideOf({smoke(5)}, 0), 1);
  EXPECT_EQ(sideOf({}, 1), 1);
  EXPECT_EQ(sideOf({}, 1, false, true), 1);
}

TEST(SmokeBlockSide, OfHalfResolutionIsTwoAtLeast) {
  EXPECT_EQ(sideOf({smoke(0.001)}, 0, false, true), 2);
  EXPECT_EQ(sideOf({smoke(5)}, 1, false, true), 4);
}

}  // namespace
}  // namespace sfumato::pipelines
