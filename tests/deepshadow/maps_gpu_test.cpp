// Deep shadow maps, read back texel by texel, against the double-precision march along the same rays.
#include "deepshadow/maps_gpu.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "scene/visible_hull.h"
#include "shaders/shared/deepshadow.h"
#include "tests/deepshadow/maps_test.h"
#include "tests/pipelines/known_scenes.h"
#include "volumes/reference_march.h"

namespace sfumato::deepshadow {
namespace {

using glm::dvec3;
using scene::Light;
using tests::KnownScene;
using tests::LightFunction;

class MapsGpu : public tests::MapsTest {
 protected:
  // The ray of a texel: a point of depth 0 and the way per unit of depth, world.
  static std::pair<dvec3, dvec3> ray(const LightFunction& map, size_t number) {
    size_t face = 0;
    while (number >= static_cast<size_t>(map.faces[face].side) * static_cast<size_t>(map.faces[face].side)) {
      number -= static_cast<size_t>(map.faces[face].side) * static_cast<size_t>(map.faces[face].side);
      ++face;
    }
    const FaceProjection& projection = map.faces[face];
    const auto side = static_cast<size_t>(projection.side);
    const glm::dvec2 texel(static_cast<double>(number % side) + 0.5,
                           static_cast<double>(number / side) + 0.5);
    const glm::dvec2 plane = (texel / static_cast<double>(side) * 2.0 - 1.0) * projection.halfExtent;
    const dvec3 start = projection.orthographic ? dvec3(plane, 0) : dvec3(0);
    const dvec3 rate = projection.orthographic ? dvec3(0, 0, -1) : dvec3(plane, -1);
    return {dvec3(projection.worldFromFace * glm::dvec4(start, 1)),
            glm::dmat3(projection.worldFromFace) * rate};
  }

  struct Errors {
    double worst = 0;
    double mean = 0;
  };

  // Largest error of the map's transmittance through smoke at random texels and depths.
  static double worstError(const LightFunction& map, const KnownScene& known) {
    return errors(map, known).worst;
  }

  static Errors errors(const LightFunction& map, const KnownScene& known) {
    base::Random random(5);
    Errors found;
    for (int i = 0; i < 1500; ++i) {
      const size_t number = random.next() % map.texels.size();
      const auto [start, rate] = ray(map, number);
      const double depth = std::min(random.uniform(0, 8), double(map.texels[number].opaqueDepth));
      const dvec3 tau = volumes::opticalDepth(known.media, start, start + depth * rate, 0.1);
      const dvec3 error = glm::abs(map.transmittance(number, depth) - glm::exp(-tau));
      found.worst = std::max({found.worst, error.r, error.g, error.b});
      found.mean += error.g / 1500;
    }
    return found;
  }
};

KnownScene smokeUnder(const Light& light) {
  KnownScene known{"smoke", {}, {}};
  known.scene.lights = {light};
  known.media = {tests::ball({0.2, 1.2, 0}, 1.1, 24, 6.0, dvec3(0.9), 0),
                 tests::block({-1.5, 0, -1}, {-0.2, 1, 1}, {9, 7, 11}, 1.5, dvec3(0.5), 0)};
  return known;
}

TEST_F(MapsGpu, TransmittanceOfSmokeStaysWithinTheErrorBoundForEveryLight) {
  const Light lights[] = {tests::directionalLight({0.4, -1, 0.2}, dvec3(1)),
                          tests::spotLight({1, 5, 2}, {0, 1, 0}, dvec3(1), 0.2, 0.5),
                          tests::spotLight({1, 5, 2}, {0, 1, 0}, dvec3(1), 0.2, 1.4),  // wide: six faces
                          tests::pointLight({0.2, 1.4, 0.1}, dvec3(1))};               // inside the smoke
  for (const Light& light : lights) {
    const KnownScene known = smokeUnder(light);
    for (const double bound : {1.0 / 32, 1.0 / 512}) {
      const LightFunction map = build(known, 64, bound);
      // Beside the bound: the march's own steps and halves of 11 bits.
      EXPECT_LT(worstError(map, known), bound + 1.0 / 1500)
          << "bound " << bound << ", light " << static_cast<int>(light.type);
    }
  }
}

TEST_F(MapsGpu, ColouredSmokeStaysWithinTheErrorBoundInEveryChannel) {
  KnownScene known = smokeUnder(tests::spotLight({1, 5, 2}, {0, 1, 0}, dvec3(1), 0.2, 0.5));
  known.media[0].extinctionColour = {0.1, 0.4, 1};
  known.media[1].extinctionColour = {2, 0, 0.5};
  for (const double bound : {1.0 / 32, 1.0 / 512})
    EXPECT_LT(worstError(build(known, 64, bound), known), bound + 1.0 / 1500) << "bound " << bound;
}

// exp(tau) of one channel is beyond what floats hold.
TEST_F(MapsGpu, AChannelThatIsDarkLeavesTheOthersAlone) {
  KnownScene known{"block", {}, {}};
  known.scene.lights = {tests::directionalLight({0, -1, 0}, dvec3(1))};
  known.media = {tests::block({-1, 0, -1}, {1, 2, 1}, {4, 64, 4}, 500.0, dvec3(0.5), 0)};
  known.media[0].extinctionColour = {0.001, 0, 1};
  const LightFunction map = build(known, 64, 1.0 / 512);
  size_t through = 0;
  for (size_t number = 0; number < map.texels.size(); ++number) {
    const auto [start, rate] = ray(map, number);
    if (std::abs(start.x) > 0.6 || std::abs(start.z) > 0.6) continue;
    ++through;
    const dvec3 behind = map.transmittance(number, start.y + 1);
    EXPECT_NEAR(behind.r, std::exp(-1.0), 1.0 / 512) << number;
    EXPECT_EQ(behind.g, 1) << number;
    EXPECT_LT(behind.b, 1e-6) << number;
  }
  EXPECT_GT(through, 10u);
}

TEST_F(MapsGpu, ATighterBoundTakesMoreKnotsAndZeroKeepsEveryStep) {
  const KnownScene known = smokeUnder(tests::directionalLight({0.4, -1, 0.2}, dvec3(1)));
  build(known, 64, 1.0 / 32);
  const size_t coarse = statistics_.knotBytes;
  build(known, 64, 1.0 / 512);
  const size_t fine = statistics_.knotBytes;
  const LightFunction all = build(known, 64, 0);
  EXPECT_LT(coarse * 3 / 2, fine);
  EXPECT_LT(fine * 3, statistics_.knotBytes);
  EXPECT_LT(worstError(all, known), 1.0 / 1000);
}

TEST_F(MapsGpu, HomogeneousSmokeTakesOneNode) {
  KnownScene known{"block", {}, {}};
  known.scene.lights = {tests::directionalLight({0, -1, 0}, dvec3(1))};
  known.media = {tests::block({-1, 0, -1}, {1, 2, 1}, {4, 200, 4}, 1.0, dvec3(0.5), 0)};
  // The ramp of one voxel at its faces is worth 0.005 of transmittance, below this bound.
  const LightFunction map = build(known, 64, 1.0 / 128);
  for (size_t number = 0; number < map.texels.size(); ++number) {
    const auto [start, rate] = ray(map, number);
    if (std::abs(start.x) > 0.6 || std::abs(start.z) > 0.6) continue;
    EXPECT_EQ(map.texels[number].knots, 2u) << number;
  }
}

TEST_F(MapsGpu, PanesAreExactColouredStepsBeforeInsideAndBehindSmoke) {
  for (const float height : {3.f, 1.f, -0.5f}) {
    KnownScene known{"pane", {}, {}};
    known.scene.lights = {tests::directionalLight({0, -1, 0}, dvec3(1))};
    known.media = {tests::block({-3, 0, -3}, {3, 2, 3}, {8, 8, 8}, 0.7, dvec3(0.5), 0)};
    tests::add(known.scene, tests::quad({-3, height, -3}, {6, 0, 0}, {0, 0, 6}),
               tests::pane({0.8f, 0.5f, 0.1f}));
    const LightFunction map = build(known, 64, 1.0 / 1024);
    const size_t middle = 32 * 64 + 32;
    const double top = ray(map, middle).first.y;
    for (double y = 3.5; y > -1; y -= 0.1) {
      const double inSmoke = std::clamp(2 - y, 0.0, 2.0);
      const dvec3 pane = y < height ? dvec3(0.8, 0.5, 0.1) : dvec3(1);
      const dvec3 expected = pane * std::exp(-0.7 * inSmoke);
      const dvec3 found = map.transmittance(middle, top - y);
      // The ramps of one voxel at the block's faces are not sharp: compare away from them.
      if (std::abs(y - 2) < 0.3 || std::abs(y) < 0.3 || std::abs(y - height) < 0.02) continue;
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found[c], expected[c], 2e-3) << "pane at " << height << ", y " << y;
    }
  }
}

TEST_F(MapsGpu, NothingBehindAnOpaqueSurfaceIsStored) {
  KnownScene known = smokeUnder(tests::directionalLight({0, -1, 0}, dvec3(1)));
  tests::add(known.scene, tests::quad({-4, 1.2f, -4}, {8, 0, 0}, {0, 0, 8}), tests::lambert({1, 1, 1}));
  tests::add(known.scene, tests::quad({-4, 0.3f, -4}, {8, 0, 0}, {0, 0, 8}), tests::pane({0.5f, 0.5f, 0.5f}));
  const LightFunction map = build(known, 64, 1.0 / 2048);  // finer than short knots are
  size_t knots = 0;
  size_t bytes = 0;
  for (const ReadMap::Texel& texel : map.texels) {
    for (size_t i = texel.firstKnot; i < texel.firstKnot + texel.knots; ++i) {
      ASSERT_LE(map.knots[i].depth, texel.opaqueDepth * (1 + 1e-5));
      const size_t before = i == texel.firstKnot ? i : i - 1;
      ASSERT_GE(map.knots[i].depth, map.knots[before].depth);
    }
    knots += texel.knots;
    bytes += (texel.knots + 1) / 2 * 16;  // two grey knots a unit
  }
  EXPECT_EQ(bytes, statistics_.knotBytes);
  EXPECT_GT(knots, 0u);
}

// Small veils one below the other, all in a few texels in the middle; each mesh has every `meshes`-th.
scene::Scene pileOfVeils(int layers, int meshes, const scene::Material& material, float top, float bottom) {
  scene::Scene scene;
  for (int first = 0; first < meshes; ++first) {
    scene::Mesh pile;
    for (int layer = first; layer < layers; layer += meshes) {
      const float height =
          top + (bottom - top) * (static_cast<float>(layer) + 0.5f) / static_cast<float>(layers);
      const scene::Mesh veil = tests::quad({-0.3f, height, -0.3f}, {0, 0, 0.6f}, {0.6f, 0, 0});
      for (const uint32_t index : veil.indices)
        pile.indices.push_back(index + static_cast<uint32_t>(pile.vertices.size()));
      pile.vertices.insert(pile.vertices.end(), veil.vertices.begin(), veil.vertices.end());
    }
    tests::add(scene, std::move(pile), material);
  }
  return scene;
}

// More than one invocation may walk on drivers that end long loops: 30,000, or 15,000 where some do not
// shadow themselves. Smoke stands in the pile's upper half.
TEST_F(MapsGpu, TexelsOfVeryManySurfacesAreExact) {
  constexpr int layers = 40000;
  for (const bool shadowSelf : {true, false}) {
    scene::Material material = tests::veil({0.2f, 0.5f, 1}, 1e-4f);
    material.shadowSelf = shadowSelf;
    KnownScene known{"pile", pileOfVeils(layers, 1, material, 3, 1), {}};
    known.scene.lights = {tests::directionalLight({0, -1, 0}, dvec3(1))};
    known.media = {tests::block({-3, 2, -3}, {3, 3, 3}, {8, 8, 8}, 0.7, dvec3(0.5), 0)};
    const LightFunction map = build(known, 32, 1.0 / 1024);
    size_t piled = 0;
    for (size_t number = 0; number < map.texels.size(); ++number) {
      const ReadMap::Texel& texel = map.texels[number];
      if (texel.knots < size_t{2} * layers) continue;
      ++piled;
      const double top = ray(map, number).first.y;
      for (double y = 2.9; y > 0.9; y -= 0.1) {
        if (std::abs(y - 2) < 0.16 || std::abs(y - 3) < 0.16) continue;  // the smoke's ramps
        const double passed = std::clamp((3 - y) / 2, 0.0, 1.0) * layers;
        const double expected = std::exp(passed * std::log1p(-1e-4) - 0.7 * std::clamp(3 - y, 0.0, 1.0));
        EXPECT_NEAR(map.transmittance(number, top - y).g, expected, 2e-3) << y;
      }
      for (size_t i = texel.firstKnot + 1; i < texel.firstKnot + texel.knots; ++i) {
        ASSERT_GE(map.knots[i].depth, map.knots[i - 1].depth) << i - texel.firstKnot;
        ASSERT_GE(map.knots[i].tauG, map.knots[i - 1].tauG) << i - texel.firstKnot;
      }
    }
    EXPECT_GE(piled, 1u);
  }
}

// Whether an object shadowed before is looked for among all surfaces before: some 800,000 steps a texel.
TEST_F(MapsGpu, ObjectsThatShadowOnceAreFoundAmongVeryManySurfaces) {
  constexpr int objects = 200;
  constexpr int layers = 8000;
  scene::Material material = tests::veil({0.2f, 0.5f, 1}, 0.01f);
  material.shadowOnce = true;
  KnownScene known{"pile", pileOfVeils(layers, objects, material, 3, 1), {}};
  known.scene.lights = {tests::directionalLight({0, -1, 0}, dvec3(1))};
  const LightFunction map = build(known, 32, 1.0 / 1024);
  size_t piled = 0;
  for (size_t number = 0; number < map.texels.size(); ++number) {
    if (map.texels[number].knots < size_t{2} * layers) continue;
    ++piled;
    const double top = ray(map, number).first.y;
    // The first surface of each object stands in the first fortieth of the pile.
    EXPECT_NEAR(map.transmittance(number, top - 2.975).r, std::pow(0.99, objects / 2), 0.01);
    EXPECT_NEAR(map.transmittance(number, top - 2.9).r, std::pow(0.99, objects), 1e-3);
    EXPECT_NEAR(map.transmittance(number, top).r, std::pow(0.99, objects), 1e-3);
  }
  EXPECT_GE(piled, 1u);
}

TEST_F(MapsGpu, WindowsAndGrowingPoolsGiveTheSameFunctions) {
  // 1536 texels a side are built in three windows, and their knots outgrow the first pool.
  KnownScene known = smokeUnder(tests::directionalLight({0.4, -1, 0.2}, dvec3(1)));
  // They take nothing, but a knot each in every texel.
  for (const float height : {0.1f, 0.2f})
    tests::add(known.scene, tests::quad({-9, height, -9}, {18, 0, 0}, {0, 0, 18}), tests::pane({1, 1, 1}));
  const LightFunction map = build(known, 1536, 1.0 / 512, 0.5);
  EXPECT_GT(lists_.windows, 1);
  // The first pool has a unit of 16 bytes for every fourth texel, and three for every fourth of smoke.
  EXPECT_GT(statistics_.knotBytes, statistics_.texels * 4 + statistics_.smokeTexels * 12);
  EXPECT_LT(worstError(map, known), 1.0 / 512 + 1.0 / 400);  // coarser steps than above
}

// Texels of surfaces may be much narrower than voxels; the smoke then has texels of its own. Between them its
// function is off by no more than at the silhouettes of a ball, whose optical depth is steep there.
TEST_F(MapsGpu, SmokeIsNoFinerThanItsVoxels) {
  for (const Light& light : {tests::directionalLight({0.4, -1, 0.2}, dvec3(1)),
                             tests::spotLight({1, 5, 2}, {0, 1, 0}, dvec3(1), 0.2, 0.5)}) {
    KnownScene known = smokeUnder(light);
    tests::add(known.scene, tests::quad({-1, -0.9f, -1}, {2, 0, 0}, {0, 0, 2}), tests::lambert({1, 1, 1}));
    build(known, 512, 1.0 / 512, 0.5);
    const LightMap coarse = statistics_;
    const LightFunction map = build(known, 1024, 1.0 / 512, 0.5);
    EXPECT_LT(coarse.smokeTexels, coarse.texels / 2);
    EXPECT_EQ(statistics_.texels, 4 * coarse.texels);
    // But for the margins of the faces.
    EXPECT_NEAR(static_cast<double>(statistics_.smokeTexels) / static_cast<double>(coarse.smokeTexels), 1,
                0.03);
    EXPECT_NEAR(static_cast<double>(statistics_.knotBytes) / static_cast<double>(coarse.knotBytes), 1, 0.03);
    const Errors found = errors(map, known);
    EXPECT_LT(found.worst, 1.0 / 64) << "mean " << found.mean;
    EXPECT_LT(found.mean, 1.0 / 2048);
  }
}

// Lights of all kinds whose faces are of one side, and one that is finer, under panes, in smoke.
TEST_F(MapsGpu, LightsThatAreBuiltTogetherHaveTheMapsThatTheyHaveAlone) {
  KnownScene known = smokeUnder(tests::directionalLight({0.4, -1, 0.2}, dvec3(1)));
  known.scene.lights.push_back(tests::spotLight({1, 5, 2}, {0, 1, 0}, dvec3(1), 0.2, 0.5));
  known.scene.lights.push_back(tests::pointLight({0.5, 3.5, 0.3}, dvec3(1)));
  known.scene.lights.push_back(tests::directionalLight({-0.3, -1, 0.1}, dvec3(1)));
  for (const float height : {2.5f, 0.2f})
    tests::add(known.scene, tests::quad({-2, height, -3}, {3, 0.5f, 0}, {0, 0, 5}),
               tests::pane({0.9f, 0.5f, height / 4}));
  tests::add(known.scene, tests::quad({-3, -1, -3}, {6, 0, 0}, {0, 0, 6}), tests::lambert({1, 1, 1}));
  const std::vector<int> resolutions = {64, 64, 128, 96};
  const pipelines::GeometryGpu geometry(device(), known.scene);
  const volumes::VolumesGpu media(device(), known.media);
  const Casters casters = pipelines::castersOf(geometry);
  const auto build = [&](const std::vector<Light>& lights, const std::vector<int>& sides,
                         const lists::ListOptions& options, Maps former = {}) {
    return Maps(device(),
                {.lights = lights,
                 .casters = casters,
                 .volumes = media,
                 .receivers = hull,
                 .castingPoints = hull,
                 .plan = {sides, 1.0 / 512},
                 .lists = options},
                std::move(former));
  };
  const auto expectAlike = [&](const Maps& together, size_t number) {
    const Maps single = build({known.scene.lights[number]}, {resolutions[number]}, {});
    const ReadMap alone = single.read(0);
    const ReadMap found = together.read(number);
    EXPECT_EQ(together.lights()[number].nodes, single.lights()[0].nodes);
    EXPECT_EQ(together.lights()[number].knotBytes, single.lights()[0].knotBytes);
    ASSERT_EQ(found.texels.size(), alone.texels.size());
    double worst = 0;
    for (size_t i = 0; i < alone.texels.size(); ++i) {
      ASSERT_EQ(found.texels[i].knots, alone.texels[i].knots) << i;
      ASSERT_FLOAT_EQ(found.texels[i].opaqueDepth, alone.texels[i].opaqueDepth) << i;
      for (size_t k = 0; k < alone.texels[i].knots; ++k) {
        const shared::ShadowKnot a = alone.knotsOf(i)[k], b = found.knotsOf(i)[k];
        worst = std::max({worst, std::abs(double(a.depth) - b.depth), std::abs(double(a.tauR) - b.tauR),
                          std::abs(double(a.tauB) - b.tauB)});
      }
    }
    EXPECT_LT(worst, 1e-4);
  };
  const Maps maps = build(known.scene.lights, resolutions, {});
  const Maps inWindows = build(known.scene.lights, resolutions, {.budgetBytes = 70000});
  EXPECT_EQ(maps.lists().windows, 2);  // the faces of 64 texels a side, the other one
  EXPECT_GT(inWindows.lists().windows, 8);
  EXPECT_GT(maps.lists().stored, 1000u);
  EXPECT_EQ(inWindows.lists().stored, maps.lists().stored);
  for (size_t i = 0; i < resolutions.size(); ++i) {
    SCOPED_TRACE(i);
    expectAlike(maps, i);
    expectAlike(inWindows, i);
  }
  // In the memory of others, larger or smaller.
  Maps former = build({known.scene.lights[1]}, {256}, {});
  Maps again = build(known.scene.lights, resolutions, {}, std::move(former));
  for (size_t i = 0; i < resolutions.size(); ++i) expectAlike(again, i);
  again = build({known.scene.lights[1]}, {64}, {}, std::move(again));
  EXPECT_EQ(again.lights().size(), 1u);
  const ReadMap small = again.read(0);
  EXPECT_EQ(small.texels.size(), 64u * 64u);
}

}  // namespace
}  // namespace sfumato::deepshadow
