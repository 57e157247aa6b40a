// Light lists against brute force: every light that reaches a point seen in a cell is in the cell's list,
// with depths that hold the point's.
#include "lights/light_lists_gpu.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/error.h"
#include "base/random.h"
#include "gl/buffer.h"
#include "lights/light_reach.h"
#include "scene/camera_view.h"
#include "shaders/shared/lights.h"
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

struct Size {
  int width = 90;  // no multiple of a cell, so that the last cells are cut
  int height = 61;
  int cellsAcross() const { return (width + LightLists::cellSide - 1) / LightLists::cellSide; }
};

// Depths between which something in a cell can be lit.
using Receivers = std::vector<glm::vec2>;

class LightListsGpu : public tests::GpuTest {
 protected:
  // Of every cell, bottom row first: the same nodes whatever builds them, and each of 8 bytes.
  std::vector<std::vector<ListedLight>> build(const std::vector<Light>& lights, const Camera& camera,
                                              const Size& size = {}, const Receivers& receivers = {}) {
    std::vector<std::vector<ListedLight>> cells =
        buildBy(LightListBuild::Compute, lights, camera, size, receivers);
    const auto rasterised = buildBy(LightListBuild::Raster, lights, camera, size, receivers);
    EXPECT_EQ(cells.size(), rasterised.size());
    size_t different = 0;
    for (size_t i = 0; i < cells.size(); ++i)
      different += !std::equal(cells[i].begin(), cells[i].end(), rasterised[i].begin(), rasterised[i].end(),
                               [](const ListedLight& a, const ListedLight& b) {
                                 return a.light == b.light && a.front == b.front && a.back == b.back;
                               });
    EXPECT_EQ(different, 0u) << "cells of " << cells.size();
    return cells;
  }

  std::vector<std::vector<ListedLight>> buildBy(LightListBuild how, const std::vector<Light>& lights,
                                                const Camera& camera, const Size& size = {},
                                                const Receivers& receivers = {}) {
    gl::Buffer view(device(), "view", sizeof(shared::ViewParams));
    view.writeValue(scene::cameraView(camera, size.width, size.height));
    const gl::Buffer depths(device(), "receivers", std::span<const glm::vec2>(receivers));
    const std::vector<ShadowFaces> shadows(lights.size());
    const LightLists built(device(), {.lights = lights,
                                      .shadows = shadows,
                                      .view = view,
                                      .width = size.width,
                                      .height = size.height,
                                      .receivers = receivers.empty() ? nullptr : &depths,
                                      .build = how});
    const auto keys = built.lists().readKeys();
    EXPECT_EQ(keys.size(), built.statistics().demand);
    EXPECT_EQ(built.statistics().nodeBytes, 8u);
    std::vector<std::vector<ListedLight>> cells;
    for (const shared::ListRun& run : built.lists().readRuns()) {
      auto& cell = cells.emplace_back();
      for (uint32_t i = run.first; i < run.first + run.count; ++i)
        cell.push_back({built.order()[keys[i].id >> LIGHT_NUMBER_SHIFT], keys[i].depth,
                        std::bit_cast<float>(keys[i].id << LIGHT_NUMBER_SHIFT)});
    }
    return cells;
  }

  // Looks at random depths in every pixel: every light that reaches the point is in its cell's list.
  void expectConservative(const std::vector<Light>& lights, const Camera& camera, const Size& size = {}) {
    expectHeld(lights, camera, size, build(lights, camera, size));
  }

  void expectHeld(const std::vector<Light>& lights, const Camera& camera, const Size& size,
                  const std::vector<std::vector<ListedLight>>& cells, const Receivers& receivers = {}) {
    const shared::ViewParams view = scene::cameraView(camera, size.width, size.height);
    Random random(7);
    size_t reached = 0;
    size_t missing = 0;
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        const auto cell =
            static_cast<size_t>(y / LightLists::cellSide * size.cellsAcross() + x / LightLists::cellSide);
        const glm::dvec2 ndc((x + random.uniform()) / size.width * 2 - 1,
                             (y + random.uniform()) / size.height * 2 - 1);
        glm::dvec2 seen(camera.nearDistance, std::min(camera.farDistance, 14.0));
        if (!receivers.empty()) seen = receivers[cell];
        const double depth = seen.x + std::pow(random.uniform(), 2.0) * (seen.y - seen.x);
        const glm::dvec2 plane = ndc * glm::dvec2(view.halfExtent) * (camera.orthographic ? 1.0 : depth);
        const glm::dvec3 p(camera.worldFromView * glm::dvec4(plane, -depth, 1.0));
        std::vector<bool> listed(lights.size(), false);
        for (const ListedLight& entry : cells[cell])
          if (entry.front <= depth && depth <= entry.back) listed[static_cast<size_t>(entry.light)] = true;
        for (size_t light = 0; light < lights.size(); ++light) {
          if (lights[light].type == LightType::Directional || !reaches(lights[light], p)) continue;
          ++reached;
          missing += !listed[light];
        }
      }
    }
    EXPECT_GT(reached, 0u);
    EXPECT_EQ(missing, 0u) << "of " << reached;
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

TEST_F(LightListsGpu, HoldAtAnySize) {
  const Camera camera = scene::lookAt({0, 1, 7}, {0, 0, 0}, 0.9);
  for (const Size& size : {Size{1, 1}, {3, 5}, {97, 1}, {2, 70}, {33, 32}})
    expectConservative(randomLights(200, 5), camera, size);
}

// Hundreds in a cell, in several parts of a tile's walk.
TEST_F(LightListsGpu, HoldThousands) {
  const Camera camera = scene::lookAt({0, 1, 7}, {0, 0, 0}, 0.9);
  std::vector<Light> lights = randomLights(4096, 6);
  for (Light& light : lights) light.range *= 0.5;
  expectConservative(lights, camera);
}

TEST_F(LightListsGpu, HoldAsManyAsANodeNumbers) {
  std::vector<Light> lights(LIGHT_MOST);
  Random random(8);
  for (Light& light : lights) {
    light.position = randomPoint(random, 3);
    light.range = 0.1;
  }
  const Camera camera = scene::lookAt({0, 1, 7}, {0, 0, 0}, 0.9);
  const Size size{16, 16};
  expectHeld(lights, camera, size, buildBy(LightListBuild::Compute, lights, camera, size));
  lights.emplace_back();
  try {
    buildBy(LightListBuild::Compute, lights, camera, size);
    FAIL() << "one too many was taken";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.exitCode, base::ExitCode::Input);
    EXPECT_NE(std::string(error.what()).find("65537 lights"), std::string::npos) << error.what();
  }
}

TEST_F(LightListsGpu, HoldWhatReachesAReceiverAndNothingElse) {
  const Camera camera = scene::lookAt({0, 1, 7}, {0, 0, 0}, 0.9);
  const std::vector<Light> lights = randomLights(300, 9);
  const auto all = build(lights, camera);
  Random random(10);
  Receivers receivers(all.size());
  for (glm::vec2& range : receivers) {
    range.x = static_cast<float>(random.uniform(0.5, 11));
    range.y = range.x + static_cast<float>(random.uniform(0, 2));
  }
  const auto cut = build(lights, camera, {}, receivers);
  expectHeld(lights, camera, {}, cut, receivers);
  size_t before = 0, after = 0;
  for (size_t i = 0; i < all.size(); ++i) {
    before += all[i].size();
    after += cut[i].size();
    for (const ListedLight& entry : cut[i]) {
      EXPECT_LE(entry.front, receivers[i].y);
      EXPECT_GE(entry.back, receivers[i].x);
    }
  }
  EXPECT_LT(after, before / 2);
  // A cell in which nothing can be lit.
  for (glm::vec2& range : receivers) range = {3e38f, -3e38f};
  for (const auto& cell : build(lights, camera, {}, receivers)) EXPECT_TRUE(cell.empty());
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
      // 0.2 m, and half a cell's diagonal at 5.2 m: 0.24 m; the back is rounded up by 1/128 at most.
      EXPECT_GT(entry.front, 4.55f);
      EXPECT_LT(entry.back, 5.45f * (1 + 1.f / 128));
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
