// What lights cover of the image, and the maps that they get for it.
#include "pipelines/shadow_resolution.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "lights/light_reach.h"
#include "scene/visible_hull.h"
#include "tests/pipelines/known_scenes.h"

namespace sfumato::pipelines {
namespace {

using glm::dvec3;
using scene::Bounds;
using scene::Light;

constexpr int width = 640;
constexpr int height = 480;

// Looks straight down from 10 m; a pixel of the floor is 1/60 m.
const scene::Camera above = tests::orthographicCamera({0, 10, 0}, {0, 0, 0}, 4, {0, 0, -1});
const std::vector<Bounds> floorParts = {{{-4, -0.1, -3}, {4, 0, 3}}};

Light lamp(const dvec3& position, double range) {
  Light light = tests::pointLight(position, dvec3(10));
  light.range = range;
  return light;
}

TEST(ShadowResolution, ALampCoversItsReachOnTheScreen) {
  EXPECT_NEAR(pixelsLit(lamp({0, 0, 0}, 1), floorParts, above, width, height), 120, 1);
  EXPECT_NEAR(pixelsLit(lamp({1, 0.5, 1}, 0.6), floorParts, above, width, height), 72, 1);
  EXPECT_NEAR(pixelsLit(lamp({0, 1, 0}, 100), floorParts, above, width, height), 480, 1);
  const Light sun = tests::directionalLight({0.3, -1, 0}, dvec3(1));
  EXPECT_NEAR(pixelsLit(sun, floorParts, above, width, height), 480, 1);
}

TEST(ShadowResolution, NothingThatIsSeenIsReached) {
  EXPECT_LT(pixelsLit(lamp({0, 3, 0}, 2), floorParts, above, width, height), 0);
  EXPECT_LT(pixelsLit(lamp({9, 0, 0}, 2), floorParts, above, width, height), 0);
  // In the box around its reach, but not in that.
  EXPECT_LT(pixelsLit(lamp({5.6, 1.6, 4.6}, 2), floorParts, above, width, height), 0);
  EXPECT_LT(pixelsLit(tests::spotLight({0, 1, 0}, {0, 2, 0}, dvec3(10), 0.2, 0.6), floorParts, above, width,
                      height),
            0);
  EXPECT_GT(pixelsLit(tests::spotLight({0, 1, 0}, {0, 0, 0}, dvec3(10), 0.2, 0.6), floorParts, above, width,
                      height),
            50);
}

TEST(ShadowResolution, MapsAreAsLargeAsWhatLightsCover) {
  const Quality quality = qualityNamed("medium");
  Light dark = lamp({0, 0, 0}, 1);
  dark.castsShadow = false;
  const std::vector<Light> lights = {lamp({0, 0, 0}, 1), lamp({0, 9, 0}, 1), dark, lamp({0, 0, 0}, 100),
                                     lamp({0, 0, 0}, 0.01)};
  const auto resolutions = shadowResolutions(lights, floorParts, above, width, height, quality);
  EXPECT_NEAR(resolutions[0], 1024 * 120 / 640, 2);
  EXPECT_EQ(resolutions[1], 0);
  EXPECT_EQ(resolutions[2], 0);
  EXPECT_NEAR(resolutions[3], 1024 * 480 / 640, 2);
  EXPECT_EQ(resolutions[4], 32);
  Quality exact = quality;
  exact.exactShadowResolution = true;
  EXPECT_EQ(shadowResolutions(lights, floorParts, above, width, height, exact),
            (std::vector<int>{1024, 0, 0, 1024, 1024}));
}

// The texels are where the camera looks.
TEST(ShadowResolution, AZoomNeedsAsManyTexelsAsTheWhole) {
  const Quality quality = qualityNamed("medium");
  const std::vector<Light> lights = {tests::spotLight({0, 10, 0}, {0, 0, 0}, dvec3(1000), 0.2, 0.3),
                                     lamp({0, 10, 0}, 100)};
  scene::Camera close = above;
  close.yMagnitude = 0.2;
  // 106 pixels of the image are 1/15 of the spot's cone, and less of a cube's face.
  const std::vector<Bounds> parts = {{{-0.2, -0.1, -0.15}, {0.2, 0, 0.15}}};
  for (const int resolution : shadowResolutions(lights, parts, close, 160, 120, quality))
    EXPECT_EQ(resolution, 1024);
  // All of the cone on as few pixels needs few.
  const std::vector<Bounds> whole = {{{-3, -0.1, -3}, {3, 0, 3}}};
  EXPECT_LT(shadowResolutions(lights, whole, above, 160, 120, quality)[0], 300);
}

// Against points: none that is seen and lit lies outside of what was found.
TEST(ShadowResolution, IsNeverTooSmall) {
  base::Random random(9);
  int lit = 0;
  for (int i = 0; i < 3000; ++i) {
    const auto somewhere = [&] {
      return dvec3(random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3));
    };
    const auto camera = tests::perspectiveCamera(somewhere(), somewhere(), random.uniform(0.3, 1.5));
    const dvec3 corner = somewhere();
    const Bounds box{corner,
                     corner + dvec3(random.uniform(0, 2), random.uniform(0, 2), random.uniform(0, 2))};
    Light light = i % 2 == 0
                      ? lamp(somewhere(), 0)
                      : tests::spotLight(somewhere(), somewhere(), dvec3(10), 0, random.uniform(0.1, 1.5));
    light.range = random.uniform(0.1, 4);
    const double aspect = double(width) / height;
    glm::dmat4 worldFromUnit(1.0);
    for (int axis = 0; axis < 3; ++axis) worldFromUnit[axis][axis] = (box.high - box.low)[axis];
    worldFromUnit[3] = glm::dvec4(box.low, 1);
    const auto part = scene::visibleParts({worldFromUnit}, camera, aspect).front();
    if (part.empty()) continue;
    const std::vector<Bounds> parts = {scene::boundsOf(part)};
    const double found = pixelsLit(light, parts, camera, width, height);
    const glm::dmat4 viewFromWorld = glm::inverse(camera.worldFromView);
    glm::dvec2 low(1e30);
    glm::dvec2 high(-1e30);
    for (int k = 0; k < 100; ++k) {
      const dvec3 p = box.low + (box.high - box.low) *
                                    dvec3(random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1));
      const dvec3 v(viewFromWorld * glm::dvec4(p, 1));
      const glm::dvec2 plane = glm::dvec2(v) / (-v.z * std::tan(camera.yfov / 2));
      if (-v.z < camera.nearDistance || std::abs(plane.x) > aspect || std::abs(plane.y) > 1) continue;
      if (!lights::reaches(light, p)) continue;
      low = glm::min(low, plane);
      high = glm::max(high, plane);
    }
    if (high.x < low.x) continue;
    ++lit;
    const glm::dvec2 pixels = (high - low) * (height / 2.0);
    EXPECT_GE(found + 1e-6, std::max(pixels.x, pixels.y)) << i;
  }
  EXPECT_GT(lit, 50);
}

}  // namespace
}  // namespace sfumato::pipelines
