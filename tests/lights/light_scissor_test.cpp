// Scissor rectangles of lights against points of what they light, projected one by one.
#include "lights/light_scissor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/random.h"
#include "lights/light_reach.h"
#include "scene/camera_view.h"

namespace sfumato::lights {
namespace {

using base::Random;
using glm::dvec2;
using glm::dvec3;
using glm::ivec4;
using scene::Camera;

constexpr int width = 97;
constexpr int height = 61;

dvec3 randomPoint(Random& random, double extent) {
  return {random.uniform(-extent, extent), random.uniform(-extent, extent), random.uniform(-extent, extent)};
}

dvec3 randomDirection(Random& random) {
  for (;;) {
    const dvec3 p = randomPoint(random, 1);
    const double length = glm::length(p);
    if (length > 0.1 && length < 1) return p / length;
  }
}

Camera randomCamera(Random& random) {
  Camera camera = scene::lookAt(randomPoint(random, 5), randomPoint(random, 5), random.uniform(0.2, 2.4));
  camera.orthographic = random.next() % 4 == 0;
  camera.yMagnitude = random.uniform(0.5, 6);
  camera.nearDistance = 0.05;
  camera.farDistance = random.next() % 2 == 0 ? 30 : scene::infinity;
  return camera;
}

Light randomPointLight(Random& random) {
  Light light;
  light.position = randomPoint(random, 8);
  light.range = random.uniform(0.01, 5);
  light.intensity = dvec3(1e4);  // so that the range is what ends it
  return light;
}

// Where the camera sees a point, in pixels from the lower left corner; nothing where it does not.
std::optional<dvec2> seenAt(const Camera& camera, const dvec3& pWorld) {
  const dvec3 right(camera.worldFromView[0]);
  const dvec3 up(camera.worldFromView[1]);
  const dvec3 back(camera.worldFromView[2]);
  const dvec3 away = pWorld - dvec3(camera.worldFromView[3]);
  const double depth = -glm::dot(away, back);
  if (depth < camera.nearDistance || depth > camera.farDistance) return {};
  const double pixelsPerMetre = camera.orthographic ? height / (2 * camera.yMagnitude)
                                                    : height / (2 * std::tan(camera.yfov / 2) * depth);
  const dvec2 pixel =
      dvec2(glm::dot(away, right), glm::dot(away, up)) * pixelsPerMetre + dvec2(width, height) * 0.5;
  if (pixel.x < 0 || pixel.y < 0 || pixel.x > width || pixel.y > height) return {};
  return pixel;
}

bool holds(const std::optional<ivec4>& rectangle, const dvec2& pixel) {
  return rectangle && pixel.x >= rectangle->x && pixel.y >= rectangle->y &&
         pixel.x <= rectangle->x + rectangle->z && pixel.y <= rectangle->y + rectangle->w;
}

// Points of a ball's surface that are seen outside of the rectangle that it gets when its radius is taken
// `factor` times as long.
size_t seenOutside(double factor) {
  Random random(3);
  size_t outside = 0;
  for (int i = 0; i < 4000; ++i) {
    const Camera camera = randomCamera(random);
    const Light light = randomPointLight(random);
    Light scaled = light;
    scaled.range *= factor;
    const auto rectangle = lightScissor(scaled, scene::cameraView(camera, width, height));
    for (int k = 0; k < 200; ++k) {
      const auto pixel = seenAt(camera, light.position + light.range * randomDirection(random));
      outside += pixel && !holds(rectangle, *pixel) ? 1 : 0;
    }
  }
  return outside;
}

TEST(LightScissor, HoldsEveryPointOfThousandsOfBalls) {
  EXPECT_EQ(seenOutside(1), 0u);
}

TEST(LightScissor, FailsThatTestWithARadiusOneTwentiethTooShort) {
  EXPECT_GT(seenOutside(0.95), 100u);
}

TEST(LightScissor, HoldsEveryPointThatASpotReaches) {
  Random random(4);
  size_t seen = 0;
  for (int i = 0; i < 4000; ++i) {
    const Camera camera = randomCamera(random);
    Light light = randomPointLight(random);
    light.type = LightType::Spot;
    light.direction = randomDirection(random);
    light.outerCone = random.uniform(0.02, (std::numbers::pi / 2));
    const auto rectangle = lightScissor(light, scene::cameraView(camera, width, height));
    for (int k = 0; k < 200; ++k) {
      const dvec3 p = light.position + light.range * random.uniform(0.0, 1.0) * randomDirection(random);
      if (!reaches(light, p)) continue;
      const auto pixel = seenAt(camera, p);
      seen += pixel ? 1 : 0;
      ASSERT_TRUE(!pixel || holds(rectangle, *pixel)) << "light " << i << ", cone " << light.outerCone;
    }
  }
  EXPECT_GT(seen, 10000u);
}

// The circle in which rays from the camera touch a ball, or of an orthographic camera its equator.
std::vector<dvec3> outline(const Camera& camera, const Ball& ball) {
  const dvec3 eye(camera.worldFromView[3]);
  const dvec3 towardsEye = camera.orthographic ? dvec3(camera.worldFromView[2]) : eye - ball.centre;
  const double distance = glm::length(towardsEye);
  const double sine = camera.orthographic ? 0 : ball.radius / distance;
  const dvec3 axis = towardsEye / distance;
  const dvec3 u = glm::normalize(glm::cross(axis, std::abs(axis.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0)));
  const dvec3 v = glm::cross(axis, u);
  std::vector<dvec3> points;
  for (int k = 0; k < 2000; ++k) {
    const double angle = k * (2 * std::numbers::pi) / 2000;
    points.push_back(ball.centre +
                     ball.radius * (sine * axis + std::sqrt(1 - sine * sine) *
                                                      (std::cos(angle) * u + std::sin(angle) * v)));
  }
  return points;
}

TEST(LightScissor, IsTightWhereTheBallIsBeforeTheCamera) {
  Random random(5);
  int tried = 0;
  for (int i = 0; i < 20000 && tried < 1500; ++i) {
    Camera camera = randomCamera(random);
    camera.farDistance = scene::infinity;
    const Light light = randomPointLight(random);
    const dvec3 eye(camera.worldFromView[3]);
    if (!camera.orthographic && glm::distance(eye, light.position) <= light.range) continue;
    dvec2 low(std::numeric_limits<double>::infinity());
    dvec2 high(-low);
    bool whole = true;  // and nowhere at the image's edge
    for (const dvec3& p : outline(camera, {light.position, light.range})) {
      const auto pixel = seenAt(camera, p);
      whole = whole && pixel;
      if (!whole) break;
      low = glm::min(low, *pixel);
      high = glm::max(high, *pixel);
    }
    if (!whole) continue;
    ++tried;
    const auto rectangle = lightScissor(light, scene::cameraView(camera, width, height));
    ASSERT_TRUE(rectangle);
    for (int axis = 0; axis < 2; ++axis) {
      EXPECT_GT((*rectangle)[axis], low[axis] - 1.01) << "light " << i;
      EXPECT_LT((*rectangle)[axis] + (*rectangle)[axis + 2], high[axis] + 1.01) << "light " << i;
    }
  }
  EXPECT_GT(tried, 300);
}

TEST(LightScissor, KnownPlaces) {
  const Camera camera = scene::lookAt({0, 0, 0}, {0, 0, -1}, (std::numbers::pi / 2));
  const shared::ViewParams view = scene::cameraView(camera, 100, 100);
  Light light;
  light.intensity = dvec3(1e4);
  light.range = 1;
  light.position = {0, 0, -std::sqrt(2.0)};  // tangents at 45 degrees: all of the image
  EXPECT_EQ(lightScissor(light, view), ivec4(0, 0, 100, 100));
  light.position = {0, 0, -std::sqrt(1 + 4.001 * 4.001)};  // tangents of slope 1/4
  EXPECT_EQ(lightScissor(light, view), ivec4(37, 37, 26, 26));
  light.position = {0, 0, 0.5};  // the camera is inside
  EXPECT_EQ(lightScissor(light, view), ivec4(0, 0, 100, 100));
  light.position = {0, 0, 1.1};  // behind
  EXPECT_EQ(lightScissor(light, view), std::nullopt);
  light.position = {0.9, 0, -0.6};  // comes beside the eye on the right; ends 11.3 degrees to the left
  EXPECT_EQ(lightScissor(light, view), ivec4(40, 0, 60, 100));
  light.position = {-20, 0, -3};  // out of the image
  EXPECT_EQ(lightScissor(light, view), std::nullopt);
  light.type = LightType::Directional;
  EXPECT_EQ(lightScissor(light, view), ivec4(0, 0, 100, 100));
}

TEST(LightScissor, ALightBeforeTheNearPlaneOrBeyondTheFarOneIsNotSeen) {
  Camera camera = scene::lookAt({0, 0, 0}, {0, 0, -1}, 1);
  camera.nearDistance = 1;
  camera.farDistance = 10;
  const shared::ViewParams view = scene::cameraView(camera, 8, 8);
  Light light;
  light.intensity = dvec3(1e4);
  light.range = 0.4;
  for (const auto& [depth, seen] : {std::pair{0.5, false}, {0.7, true}, {10.3, true}, {10.5, false}}) {
    light.position = {0, 0, -depth};
    EXPECT_EQ(lightScissor(light, view).has_value(), seen) << depth;
  }
}

}  // namespace
}  // namespace sfumato::lights
