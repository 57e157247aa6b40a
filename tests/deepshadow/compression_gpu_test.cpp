// The compression of deep shadow maps: its error bound against the same march with every step kept, what it
// saves, and the one budget of all maps.
#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>

#include "base/error.h"
#include "base/random.h"
#include "scene/default_set.h"
#include "shaders/shared/deepshadow.h"
#include "tests/deepshadow/maps_test.h"
#include "volumes/vdb_file.h"

namespace sfumato::deepshadow {
namespace {

using glm::dvec3;
using tests::KnownScene;
using tests::LightFunction;

class CompressionGpu : public tests::MapsTest {};

// Density without any coherence, and holes: the worst there is for a compression.
volumes::Medium noise(uint64_t seed) {
  constexpr int n = 14;
  volumes::Medium medium = tests::ball({0, 1, 0}, 1.2, n, 5.0, dvec3(0.9), 0);
  base::Random random(seed);
  for (float& value : medium.grid.values)
    if (value > 0) value = random.uniform(0, 1) < 0.3 ? 0.f : static_cast<float>(random.uniform(0, 1));
  return medium;
}

// Largest difference of two maps' transmittance over all texels and channels: at the knots of both, on both
// sides of steps, and between knots.
double worstDifference(const LightFunction& a, const LightFunction& b) {
  EXPECT_EQ(a.texels.size(), b.texels.size());
  double worst = 0;
  for (size_t number = 0; number < a.texels.size(); ++number) {
    EXPECT_EQ(a.texels[number].opaqueDepth, b.texels[number].opaqueDepth);
    std::vector<double> depths = {0, 1e6};
    for (const LightFunction* map : {&a, &b}) {
      const ReadMap::Texel& texel = map->texels[number];
      for (size_t i = texel.firstKnot; i < texel.firstKnot + texel.knots; ++i)
        depths.push_back(map->knots[i].depth);
    }
    std::sort(depths.begin(), depths.end());
    const double end = a.texels[number].opaqueDepth;
    for (size_t i = 0; i + 1 < depths.size(); ++i) {
      const double middle = 0.5 * (depths[i] + depths[i + 1]);
      const double before = depths[i] * (1 - 1e-9);  // of a step
      for (const double depth : {before, depths[i], middle}) {
        const dvec3 off =
            a.transmittance(number, std::min(depth, end)) - b.transmittance(number, std::min(depth, end));
        worst = std::max({worst, std::abs(off.r), std::abs(off.g), std::abs(off.b)});
      }
    }
  }
  return worst;
}

// Floats of the march's sums; the bound itself is not loosened.
constexpr double rounding = 2e-5;

TEST_F(CompressionGpu, NeverErrsByMoreThanItsBoundInNoiseThroughPanesFromEveryLight) {
  const scene::Light lights[] = {tests::directionalLight({0.4, -1, 0.2}, dvec3(1)),
                                 tests::spotLight({1, 5, 2}, {0, 1, 0}, dvec3(1), 0.2, 0.5),
                                 tests::pointLight({0.2, 1.4, 0.1}, dvec3(1))};
  for (const scene::Light& light : lights) {
    for (const dvec3& colour : {dvec3(1), dvec3(1, 0.6, 0.3)}) {
      KnownScene known{"noise", {}, {}};
      known.scene.lights = {light};
      known.media = {noise(3)};
      known.media[0].extinctionColour = colour;
      tests::add(known.scene, tests::quad({-3, 0.8f, -3}, {2.5f, 0.4f, 0}, {0, 0, 6}),
                 tests::pane({0.8f, 0.5f, 0.1f}));
      tests::add(known.scene, tests::quad({-0.5f, 0.9f, -3}, {3.5f, 0.4f, 0}, {0, 0, 6}),
                 tests::veil({1, 1, 1}, 0.3f));
      const LightFunction all = build(known, 48, 0);
      const size_t allBytes = statistics_.knotBytes;
      for (const double bound : {1.0 / 16, 1.0 / 128, 1.0 / 512, 1.0 / 4096}) {
        const LightFunction map = build(known, 48, bound);
        const double worst = worstDifference(map, all);
        EXPECT_LT(worst, bound + rounding) << "light " << static_cast<int>(light.type);
        EXPECT_GT(worst, bound / 4) << "it would pass unused";
        EXPECT_LT(statistics_.knotBytes, allBytes);
      }
    }
  }
}

// With 0 every step of the march is a knot: as many as the slab's depth has steps, and two for its faces.
TEST_F(CompressionGpu, ZeroMakesAKnotOfEveryStep) {
  KnownScene known{"slab", {}, {}};
  known.scene.lights = {tests::directionalLight({0, -1, 0}, dvec3(1))};
  known.media = {tests::block({-3, 0, -3}, {3, 2, 3}, {4, 20, 4}, 0.3, dvec3(0.5), 0)};
  const LightFunction map = build(known, 32, 0, 0.5);
  const ReadMap::Texel& texel = map.texels[16 * 32 + 16];
  // 20 voxels of 0.1 m and the ramps beside them, in steps of 0.05 m.
  EXPECT_NEAR(static_cast<double>(texel.knots), 43, 2);
  for (size_t i = texel.firstKnot + 1; i < texel.firstKnot + texel.knots; ++i)
    EXPECT_NEAR(map.knots[i].depth - map.knots[i - 1].depth, 0.05, 1e-4);
}

KnownScene realSmoke(const scene::Light& light, const std::string& file) {
  KnownScene known{"smoke", {}, {}};
  known.scene.lights = {light};
  volumes::Medium medium{.grid = volumes::readVdb(file, "density")};
  // Two metres high, on the ground.
  const glm::dvec3 size(medium.grid.size);
  const double voxel = 2.0 / size.y;
  medium.worldFromIndex = glm::dmat4(voxel);
  medium.worldFromIndex[3] =
      glm::dvec4(-voxel * (dvec3(medium.grid.origin) + dvec3(size.x / 2, 0, size.z / 2)), 1);
  medium.scale = scene::fittingScale(medium);  // as `sfumato render` draws it
  known.media = {medium};
  return known;
}

TEST_F(CompressionGpu, OfRealSmokeTakesAQuarterOfTheBytesAtMost) {
  const char* folder = std::getenv("SFUMATO_DATA");
  if (folder == nullptr) GTEST_SKIP() << "SFUMATO_DATA names no folder with openvdb_smoke.vdb";
  const std::string file = std::string(folder) + "/openvdb_smoke.vdb";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
  const scene::Light lights[] = {tests::directionalLight({0.4, -1, 0.2}, dvec3(1)),
                                 tests::spotLight({1, 5, 2}, {0, 1, 0}, dvec3(1), 0.2, 0.3)};
  for (const scene::Light& light : lights) {
    const KnownScene known = [&] {
      try {
        return realSmoke(light, file);
      } catch (const base::Error& error) {
        return KnownScene{error.what(), {}, {}};
      }
    }();
    if (known.media.empty()) GTEST_SKIP() << known.name;
    // As a camera sees it that sees nothing else.
    hull.clear();
    for (int i = 0; i < 8; ++i)
      hull.emplace_back(volumes::worldFromUnit(known.media[0]) * glm::dvec4(i & 1, i >> 1 & 1, i >> 2, 1));
    for (const double step : {1.5, 1.0}) {
      build(known, 512, 0, step);
      const auto texels =
          static_cast<double>((statistics_.texels + statistics_.smokeTexels) * sizeof(shared::ShadowTexel));
      const auto all = static_cast<double>(statistics_.knotBytes);
      build(known, 512, 1.0 / 512, step);
      const auto compressed = static_cast<double>(statistics_.knotBytes);
      fmt::print(
          "light {}, steps of {} voxels: {:.2f} MiB of knots of {:.2f} MiB: {:.3f}; with the texels' own "
          "{:.2f} MiB: {:.3f}\n",
          static_cast<int>(light.type), step, compressed / 0x1p20, all / 0x1p20, compressed / all,
          texels / 0x1p20, (compressed + texels) / (all + texels));
      EXPECT_LT(compressed, 0.25 * all);
      if (step <= 1) {
        EXPECT_LT(compressed + texels, 0.25 * (all + texels));
      }
    }
    // Few texels, all of their depths.
    EXPECT_LT(worstDifference(build(known, 64, 1.0 / 512, 1.5), build(known, 64, 0, 1.5)),
              1.0 / 512 + rounding);
  }
}

class ShadowBudgetGpu : public tests::MapsTest {
 protected:
  Maps maps(const KnownScene& known, const MapPlan& plan, const MapBudget& budget) {
    const pipelines::GeometryGpu geometry(device(), known.scene);
    const volumes::VolumesGpu media(device(), known.media);
    const Casters casters = pipelines::castersOf(geometry);
    return Maps(device(), {.lights = known.scene.lights,
                           .casters = casters,
                           .volumes = media,
                           .receivers = hull,
                           .castingPoints = hull,
                           .plan = plan,
                           .budget = budget,
                           .stepVoxels = 0.5});
  }

  static KnownScene threeLights() {
    KnownScene known{"three lights", {}, {}};
    known.scene.lights = {tests::directionalLight({0.4, -1, 0.2}, dvec3(1)),
                          tests::spotLight({1, 5, 2}, {0, 1, 0}, dvec3(1), 0.2, 0.5),
                          tests::pointLight({0.2, 1.4, 0.1}, dvec3(1))};
    known.media = {noise(5)};
    tests::add(known.scene, tests::quad({-3, 0.8f, -3}, {6, 0, 0}, {0, 0, 6}),
               tests::pane({0.8f, 0.5f, 0.1f}));
    return known;
  }
};

TEST_F(ShadowBudgetGpu, AllMapsAreCoarserTogetherUntilTheyFit) {
  const KnownScene known = threeLights();
  const MapPlan asked{{256, 256, 256}, 1.0 / 512};
  const Maps whole = maps(known, asked, {});
  EXPECT_FALSE(whole.lowered());
  for (const double share : {0.9, 0.5, 0.1, 0.02}) {
    const auto bytes = static_cast<size_t>(share * static_cast<double>(whole.bytes()));
    const Maps fitted = maps(known, asked, {.bytes = bytes});
    EXPECT_LE(fitted.bytes(), bytes);
    EXPECT_GT(fitted.bytes(), bytes / 4) << "much coarser than it had to be";
    EXPECT_TRUE(fitted.lowered());
    for (const int resolution : fitted.plan().resolutions)
      EXPECT_EQ(resolution, fitted.plan().resolutions[0]);
    // Counted at an eighth of the side.
    EXPECT_NEAR(static_cast<double>(fitted.predictedBytes()) / static_cast<double>(fitted.bytes()), 1, 0.25);
  }
}

// Nobody counts beforehand what looks small; where it is not, it is counted then.
TEST_F(ShadowBudgetGpu, MoreSurfacesThanUsualAreFoundOutAndFit) {
  KnownScene known{"many panes", {}, {}};
  known.scene.lights = {tests::directionalLight({0.1, -1, 0.2}, dvec3(1))};
  for (int i = 0; i < 40; ++i)
    tests::add(known.scene, tests::quad({-4, 0.05f * static_cast<float>(i), -4}, {8, 0, 0}, {0, 0, 8}),
               tests::pane({0.9f, 0.95f, 0.97f}));
  const MapPlan asked{{128}, 1.0 / 512};
  const Maps whole = maps(known, asked, {});
  EXPECT_EQ(whole.predictedBytes(), 0u);
  EXPECT_GT(whole.bytes(), 128u * 128u * 40u * 16u / 2u);
  const size_t bytes = whole.bytes() / 2;
  const Maps fitted = maps(known, asked, {.bytes = bytes});
  EXPECT_GT(fitted.predictedBytes(), 0u);
  EXPECT_LE(fitted.bytes(), bytes);
  EXPECT_GT(fitted.bytes(), bytes / 2);
}

TEST_F(ShadowBudgetGpu, WhatWasAskedForExactlyIsKept) {
  const KnownScene known = threeLights();
  const MapPlan asked{{128, 128, 128}, 1.0 / 2048};
  const size_t bytes = maps(known, asked, {}).bytes() * 19 / 20;  // the texels alone take most of them
  const Maps looser = maps(known, asked, {.bytes = bytes, .lowerResolution = false});
  EXPECT_EQ(looser.plan().resolutions, asked.resolutions);
  EXPECT_GT(looser.plan().error, asked.error);
  EXPECT_LE(looser.bytes(), bytes);
  const Maps smaller = maps(known, asked, {.bytes = bytes, .loosenError = false});
  EXPECT_EQ(smaller.plan().error, asked.error);
  EXPECT_LT(smaller.plan().resolutions[0], 128);
  try {
    maps(known, asked, {.bytes = bytes, .lowerResolution = false, .loosenError = false});
    FAIL() << "more than the budget";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.exitCode, base::ExitCode::Memory);
  }
}

TEST_F(ShadowBudgetGpu, LightsWithoutAMapCostNothing) {
  const KnownScene known = threeLights();
  const Maps some = maps(known, {{0, 64, 0}, 1.0 / 512}, {});
  EXPECT_EQ(some.lights()[0].firstFace, -1);
  EXPECT_EQ(some.lights()[0].texels + some.lights()[2].texels, 0u);
  EXPECT_EQ(some.lights()[1].texels, 64u * 64u);
  const Maps none = maps(known, {{0, 0, 0}, 1.0 / 512}, {});
  EXPECT_EQ(none.bytes(), 0u);
}

}  // namespace
}  // namespace sfumato::deepshadow
