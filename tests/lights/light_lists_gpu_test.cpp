// Light lists against brute force: every light that reaches a point seen in a cell is in the cell's list,
// with depths that hold the point's.
#include "lights/light_lists_gpu.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/random.h"
#include "gl/buffer.h"
#include "lights/light_reach.h"
#include "scene/camera_view.h"
#include "tests/gl/test_device.h"

namespace sfumato::lights {
namespace {

using base::Random;
using scene::Camera;
using scene::Light;
using scene::LightType;

glm::dvec3 randomPoint(Random& random, double extent) {
  return {random.uniform(-extent, extent), random.uniform(-extent, extent), random.uniform(-extent, extent)};
}

std::vector<Light> randomLights(int count, uint64_t seed) {
  Random random(seed);
  std::vector<Light> lights;
  for (int i = 0; i < count; ++i) {
    Light light;
    light.type = static_cast<LightType>(random.next() % 3);
    light.position = randomPoint(random, 6);
    light.direction = glm::normalize(randomPoint(random, 1));
    light.intensity = glm::dvec3(random.uniform(0.5, 5));
    light.range = random.uniform(0.05, 4);
    light.outerCone = random.uniform(0.02, 1.57);
    light.innerCone = light.outerCone * random.uniform(0, 0.99);
    lights.push_back(light);
  }
  return lights;
}

struct ListedLight {
  int light;
  float front;
  float back;
};

class LightListsGpu : public tests::GpuTest {
 protected:
  static constexpr int width = 90;  // no multiple of a cell, so that the last cells are cut
  static constexpr int height = 61;

  // Of every cell, bottom row first.
  std::vector<std::vector<ListedLight>> build(const std::vector<Light>& lights, const Camera& camera) {
    gl::Buffer view(device(), "view", sizeof(shared::ViewParams));
    view.writeValue(scene::cameraView(camera, width, height));
    const std::vector<ShadowFaces> shadows(lights.size());
    const LightLists built(device(), {lights, shadows, view, width, height});
    const auto keys = built.lists().readKeys();
    const auto backs = built.lists().readPayloads();
    EXPECT_EQ(keys.size(), built.statistics().demand);
    std::vector<std::vector<ListedLight>> cells;
    for (const shared::ListRun& run : built.lists().readRuns()) {
      auto& cell = cells.emplace_back();
      for (uint32_t i = run.first; i < run.first + run.count; ++i)
        cell.push_back({built.order()[keys[i].id], keys[i].depth, std::bit_cast<float>(backs[i])});
    }
    return cells;
  }

  // Looks at random depths in every pixel. Returns how many listings were needed, and how many of the lists'
  // held.
  void expectConservative(const std::vector<Light>& lights, const Camera& camera) {
    const auto cells = build(lights, camera);
    const int cellsAcross = (width + LightLists::cellSide - 1) / LightLists::cellSide;
    const shared::ViewParams view = scene::cameraView(camera, width, height);
    Random random(7);
    size_t reached = 0;
    size_t missing = 0;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const glm::dvec2 ndc((x + random.uniform()) / width * 2 - 1, (y + random.uniform()) / height * 2 - 1);
        const double farthest = std::min(camera.farDistance, 14.0);
        const double depth =
            camera.nearDistance + std::pow(random.uniform(), 2.0) * (farthest - camera.nearDistance);
        const glm::dvec2 plane = ndc * glm::dvec2(view.halfExtent) * (camera.orthographic ? 1.0 : depth);
        const glm::dvec3 p(camera.worldFromView * glm::dvec4(plane, -depth, 1.0));
        const auto& cell =
            cells[static_cast<size_t>(y / LightLists::cellSide * cellsAcross + x / LightLists::cellSide)];
        for (size_t light = 0; light < lights.size(); ++light) {
          if (lights[light].type == LightType::Directional || !reaches(lights[light], p)) continue;
          ++reached;
          missing += std::none_of(cell.begin(), cell.end(), [&](const ListedLight& listed) {
            return listed.light == static_cast<int>(light) && listed.front <= depth && depth <= listed.back;
          });
        }
      }
    }
    EXPECT_GT(reached, 200u);
    EXPECT_EQ(missing, 0u);
  }
};

TEST_F(LightListsGpu, HoldEveryLightThatReachesAPoint) {
  Camera camera = scene::lookAt({0, 1, 7}, {0, 0, 0}, 0.9);
  camera.nearDistance = 0.1;
  expectConservative(randomLights(120, 1), camera);
  camera.farDistance = 9;
  expectConservative(randomLights(120, 2), camera);
}

TEST_F(LightListsGpu, HoldWithTheCameraInsideLights) {
  std::vector<Light> lights = randomLights(40, 3);
  for (Light& light : lights) light.position *= 0.2;
  expectConservative(lights, scene::lookAt({0, 0, 0.3}, {0.2, 0.1, -1}, 1.6));
}

TEST_F(LightListsGpu, HoldForAnOrthographicCamera) {
  Camera camera = scene::lookAt({2, 3, 7}, {0, 0, 0}, 1);
  camera.orthographic = true;
  camera.yMagnitude = 4;
  camera.farDistance = 30;
  expectConservative(randomLights(120, 4), camera);
}

TEST_F(LightListsGpu, AreNotLongerThanTheLightsAreLarge) {
  // A small light far off the axis is in few cells, and only between depths around it.
  Light light;
  light.position = {1, 0.5, -5};
  light.range = 0.2;
  Camera camera = scene::lookAt({0, 0, 0}, {0, 0, -1}, 0.9);
  size_t listed = 0;
  for (const auto& cell : build({light}, camera)) {
    listed += cell.size();
    for (const ListedLight& entry : cell) {
      // 0.2 m, and half a cell's diagonal at 5.2 m: 0.24 m.
      EXPECT_GT(entry.front, 4.55f);
      EXPECT_LT(entry.back, 5.45f);
    }
  }
  // Its disc covers pi (0.2 / (5 tan 0.45) * 61 / 2 / 4)^2 = 1.3 cells; those that its edge touches come to
  // that.
  EXPECT_GE(listed, 1u);
  EXPECT_LE(listed, 12u);
}

TEST_F(LightListsGpu, DirectionalAndDarkLightsStandOutside) {
  Light sun;
  sun.type = LightType::Directional;
  Light dark;
  dark.intensity = glm::dvec3(0);
  for (const auto& cell : build({sun, dark}, scene::lookAt({0, 0, 3}, {0, 0, 0}, 1)))
    EXPECT_TRUE(cell.empty());
}

TEST(LightReach, EndsWhereTheIrradianceFallsBelowTheCutoff) {
  Light light;
  light.intensity = {1, 4, 2};
  EXPECT_DOUBLE_EQ(reach(light), std::sqrt(4 / irradianceCutoff));
  light.range = 3;
  EXPECT_DOUBLE_EQ(reach(light), 3);
}

}  // namespace
}  // namespace sfumato::lights
