#include "scene/fire_lights.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "volumes/fire.h"
#include "volumes/procedural_smoke.h"

namespace sfumato::scene {
namespace {

using glm::dvec3;
using lights::Light;
using volumes::Fire;

// Emits (1, 2, 3) per metre where a voxel holds 1; voxels of 0.1 x 0.2 x 0.5 m.
Fire fireOf(const std::vector<std::pair<glm::ivec3, float>>& voxels) {
  volumes::DensityGrid grid;
  grid.size = {40, 20, 20};
  grid.values.assign(grid.valueIndex(0, 0, 20), 0.f);
  for (const auto& [at, value] : voxels) grid.values[grid.valueIndex(at.x, at.y, at.z)] = value;
  const glm::dmat4 worldFromIndex(0.1, 0, 0, 0, 0, 0.2, 0, 0, 0, 0, 0.5, 0, 5, 0, 0, 1);
  return volumes::makeFire(std::move(grid), worldFromIndex, {.ramp = {{0, 0, 0}, {1, 2, 3}}}, "test");
}

dvec3 totalOf(const std::vector<Light>& lights) {
  dvec3 sum(0);
  for (const Light& light : lights) sum += light.intensity;
  return sum;
}

void expectNear(const dvec3& a, const dvec3& b) {
  EXPECT_NEAR(glm::distance(a, b), 0, 1e-9 * (1 + glm::length(b)));
}

TEST(FireLights, OneStandsInTheMiddleOfThePower) {
  const auto lights = fireLights(fireOf({{{10, 5, 5}, 1.f}, {{20, 5, 5}, 0.25f}}), 1);
  ASSERT_EQ(lights.size(), 1u);
  expectNear(lights[0].position, {5 + 0.1 * 12, 1, 2.5});
  expectNear(lights[0].intensity, 1.25 * 0.01 * dvec3(1, 2, 3));
  EXPECT_TRUE(lights[0].castsShadow);
  EXPECT_EQ(lights[0].type, lights::LightType::Point);
}

TEST(FireLights, EachHotSpotGetsItsOwn) {
  const auto lights =
      fireLights(fireOf({{{5, 5, 5}, 1.f}, {{6, 5, 5}, 1.f}, {{30, 5, 5}, 1.f}, {{31, 5, 5}, 1.f}}), 2);
  ASSERT_EQ(lights.size(), 2u);
  expectNear(lights[0].position, {5.55, 1, 2.5});
  expectNear(lights[1].position, {8.05, 1, 2.5});
  expectNear(lights[0].intensity, 2 * 0.01 * dvec3(1, 2, 3));
  expectNear(lights[1].intensity, lights[0].intensity);
}

TEST(FireLights, HaveThePowerOfTheFireHoweverManyTheyAre) {
  volumes::FlameGrids flame = volumes::makeFlame(40, 2, 1);
  const glm::dmat4 place = flame.temperature.worldFromIndex;
  const Fire fire =
      volumes::makeFire(std::move(flame.temperature), place, volumes::usualLook("temperature"), "test");
  dvec3 power(0);
  for (const float value : fire.grid.values)
    power += volumes::emissionOf(fire, value) * std::pow(2.0 / 40, 3);
  for (const int count : {1, 2, 7, 64}) {
    const std::vector<Light> lights = fireLights(fire, count);
    EXPECT_EQ(lights.size(), static_cast<size_t>(count));
    expectNear(totalOf(lights), power);
    for (const Light& light : lights) {
      EXPECT_GT(light.position.y, 0);
      EXPECT_LT(light.position.y, 2);
    }
    const std::vector<Light> again = fireLights(fire, count);
    for (size_t i = 0; i < lights.size(); ++i) EXPECT_EQ(lights[i].position, again[i].position);
  }
}

TEST(FireLights, AreNoMoreThanItsVoxelsAndNoneInTheDark) {
  EXPECT_EQ(fireLights(fireOf({{{5, 5, 5}, 1.f}, {{30, 5, 5}, 1.f}}), 64).size(), 2u);
  EXPECT_TRUE(fireLights(fireOf({}), 8).empty());
  EXPECT_TRUE(fireLights(fireOf({{{5, 5, 5}, 1.f}}), 0).empty());
}

}  // namespace
}  // namespace sfumato::scene
