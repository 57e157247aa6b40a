// Texels of smoke: how many a face has, and how maps that were read back join them with those of surfaces.
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "deepshadow/read_map.h"
#include "deepshadow/shadow_faces.h"

namespace sfumato::deepshadow {
namespace {

using glm::dvec3;

constexpr double endless = std::numeric_limits<double>::infinity();

// The image of the unit cube: from `low` to `high`.
glm::dmat4 box(const dvec3& low, const dvec3& high) {
  glm::dmat4 worldFromUnit(1);
  for (int axis = 0; axis < 3; ++axis) worldFromUnit[axis][axis] = high[axis] - low[axis];
  worldFromUnit[3] = glm::dvec4(low, 1);
  return worldFromUnit;
}

// Looks along -z from the origin.
FaceProjection faceOf(bool orthographic, double halfExtent, int side) {
  FaceProjection face;
  face.orthographic = orthographic;
  face.halfExtent = glm::dvec2(halfExtent);
  face.side = side;
  return face;
}

TEST(SmokeSide, OfParallelLightIsTheFacesWidthInSteps) {
  const FaceProjection face = faceOf(true, 2, 512);
  for (const double far : {3.0, 300.0})
    EXPECT_EQ(smokeSide(face, box({-1, -1, -far}, {1, 1, -1}), 0.0399, endless), 101);
}

TEST(SmokeSide, OfALampIsTheWidthWhereItsSmokeIsFarthest) {
  const FaceProjection face = faceOf(false, 1, 512);
  const glm::dmat4 smoke = box({-1, -1, -3}, {1, 1, -2});
  EXPECT_EQ(smokeSide(face, smoke, 0.0499, endless), 121);
  EXPECT_EQ(smokeSide(face, smoke, 0.0499, 2.5), 101);  // the lamp gives nothing beyond
}

TEST(SmokeSide, IsNoMoreThanTheFacesAndNoLessThanASixteenth) {
  const FaceProjection face = faceOf(false, 1, 512);
  EXPECT_EQ(smokeSide(face, box({-1, -1, -3}, {1, 1, -2}), 1e-4, endless), 512);
  EXPECT_EQ(smokeSide(face, box({-1, -1, -3}, {1, 1, -2}), 10, endless), 32);
  EXPECT_EQ(smokeSide(face, box({-1, -1, 2}, {1, 1, 3}), 0.01, endless), 32);  // behind the lamp
}

ReadMap mapOf(const std::vector<std::vector<shared::ShadowKnot>>& texels) {
  ReadMap map;
  for (const auto& knots : texels) {
    map.texels.push_back({map.knots.size(), knots.size(), NOTHING_OPAQUE});
    map.knots.insert(map.knots.end(), knots.begin(), knots.end());
  }
  return map;
}

shared::ShadowKnot grey(float depth, float tau) {
  return {depth, tau, tau, tau};
}

// 4 x 4 texels of surfaces, 2 x 2 of smoke: the middle of texel (1, 0) lies a quarter of the way from smoke
// (0, 0) to (1, 0), beside the edge. The one begins at 1 and rises by 1 a metre up to 3, the other at 2 by 4.
TEST(ReadMap, JoinsSurfacesWithTheSmokeAroundThem) {
  FaceProjection face = faceOf(true, 1, 4);
  face.smokeSide = 2;
  const std::vector<shared::ShadowKnot> slow = {grey(1, 0), grey(3, 2)};
  const std::vector<shared::ShadowKnot> fast = {grey(2, 0), grey(3, 4)};
  std::vector<std::vector<shared::ShadowKnot>> surfaces(16);
  surfaces[1] = {grey(2.5f, 0), grey(2.5f, 10)};
  ReadMap joined;
  appendJoined(face, mapOf(surfaces), mapOf({slow, fast, slow, fast}), joined);
  ASSERT_EQ(joined.texels.size(), 16u);
  const auto knots = joined.knotsOf(1);
  const std::vector<shared::ShadowKnot> expected = {
      grey(1, 0),
      grey(2, 0.75f),
      grey(2.5f, 0.75f * 1.5f + 0.25f * 2),
      grey(2.5f, 10 + 0.75f * 1.5f + 0.25f * 2),
      grey(3, 10 + 0.75f * 2 + 0.25f * 4),
  };
  ASSERT_EQ(knots.size(), expected.size());
  for (size_t i = 0; i < knots.size(); ++i) {
    EXPECT_EQ(knots[i].depth, expected[i].depth) << i;
    EXPECT_NEAR(knots[i].tauG, expected[i].tauG, 1e-6) << i;
  }
  const auto corner = joined.knotsOf(0);  // outside of the middles of all smoke: the nearest
  ASSERT_FALSE(corner.empty());
  EXPECT_EQ(corner.back().tauR, 2);
}

TEST(ReadMap, WithoutSmokeIsThatOfTheSurfaces) {
  const FaceProjection face = faceOf(true, 1, 1);
  ReadMap joined;
  appendJoined(face, mapOf({{grey(1, 0), grey(1, 2)}}), {}, joined);
  ASSERT_EQ(joined.knots.size(), 2u);
  EXPECT_EQ(joined.knots[0].tauR, 0);
  EXPECT_EQ(joined.knots[1].tauR, 2);
}

}  // namespace
}  // namespace sfumato::deepshadow
