// Deep shadow maps, read back texel by texel, against the double-precision march along the same rays.
#include "deepshadow/maps_gpu.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "pipelines/geometry_gpu.h"
#include "scene/light_faces.h"
#include "scene/visible_hull.h"
#include "shaders/shared/deepshadow.h"
#include "tests/gl/test_device.h"
#include "tests/pipelines/known_scenes.h"
#include "volumes/reference_march.h"

namespace sfumato::deepshadow {
namespace {

using glm::dvec3;
using scene::Light;
using tests::KnownScene;

// A light's map on the CPU.
struct ReadMap {
  std::vector<FaceProjection> faces;
  std::vector<shared::ShadowTexel> texels;
  std::vector<shared::ShadowKnot> knots;

  // Transmittance of a texel at a depth, by walking its knots in double precision.
  dvec3 transmittance(size_t number, double depth) const {
    const shared::ShadowTexel& texel = texels[number];
    if (depth > texel.opaqueDepth) return dvec3(0);
    dvec3 tau(0);
    for (size_t i = 0; i < texel.count; ++i) {
      const shared::ShadowKnot& knot = knots[texel.first + i];
      if (knot.depth > depth) {
        if (i == 0) break;
        const shared::ShadowKnot& before = knots[texel.first + i - 1];
        tau += (depth - before.depth) / (knot.depth - before.depth) *
               (dvec3(knot.tauR, knot.tauG, knot.tauB) - tau);
        break;
      }
      tau = {knot.tauR, knot.tauG, knot.tauB};
    }
    return glm::exp(-tau);
  }
};

class MapsGpu : public tests::GpuTest {
 protected:
  ReadMap build(const KnownScene& known, int resolution, double error, double stepVoxels = 0.25) {
    const pipelines::GeometryGpu geometry(device(), known.scene);
    const volumes::VolumesGpu media(device(), known.media);
    const Casters casters{.opaque = [&] { geometry.draw(pipelines::Layer::ShadowDepth, false); },
                          .listed = [&] { geometry.draw(pipelines::Layer::ShadowLists, false); },
                          .once = geometry.hasShadowOnce()};
    const std::vector<dvec3> hull = {{-4, -1, -4}, {4, 4, 4},  {-4, 4, 4},
                                     {4, -1, -4},  {4, -1, 4}, {-4, 4, -4}};
    const Maps maps(device(), {.lights = known.scene.lights,
                               .casters = casters,
                               .volumes = media,
                               .receivers = hull,
                               .castingPoints = hull,
                               .resolution = resolution,
                               .stepVoxels = stepVoxels,
                               .error = error});
    statistics_ = maps.lights().front();
    EXPECT_EQ(maps.cutMarches(), 0u);
    ReadMap map;
    map.faces = scene::facesOf(known.scene.lights.front(), resolution, hull, hull);
    map.texels = maps.texels().readValues<shared::ShadowTexel>(statistics_.texels);
    map.knots =
        maps.knots().readValues<shared::ShadowKnot>(maps.knots().bytes() / sizeof(shared::ShadowKnot));
    return map;
  }

  // The ray of a texel: a point of depth 0 and the way per unit of depth, world.
  static std::pair<dvec3, dvec3> ray(const ReadMap& map, size_t number) {
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

  // Largest error of the map's transmittance through smoke at random texels and depths.
  static double worstError(const ReadMap& map, const KnownScene& known) {
    base::Random random(5);
    double worst = 0;
    for (int i = 0; i < 1500; ++i) {
      const size_t number = random.next() % map.texels.size();
      const auto [start, rate] = ray(map, number);
      const double depth = std::min(random.uniform(0, 8), double(map.texels[number].opaqueDepth));
      const double tau = volumes::opticalDepth(known.media, start, start + depth * rate, 0.1);
      worst = std::max(worst, std::abs(map.transmittance(number, depth).r - std::exp(-tau)));
    }
    return worst;
  }

  LightMap statistics_;
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
      const ReadMap map = build(known, 64, bound);
      // Beside the bound: the march's own steps and halves of 11 bits.
      EXPECT_LT(worstError(map, known), bound + 1.0 / 1500)
          << "bound " << bound << ", light " << static_cast<int>(light.type);
    }
  }
}

TEST_F(MapsGpu, ATighterBoundTakesMoreKnotsAndZeroKeepsEveryStep) {
  const KnownScene known = smokeUnder(tests::directionalLight({0.4, -1, 0.2}, dvec3(1)));
  build(known, 64, 1.0 / 32);
  const size_t coarse = statistics_.knots;
  build(known, 64, 1.0 / 512);
  const size_t fine = statistics_.knots;
  const ReadMap all = build(known, 64, 0);
  EXPECT_LT(coarse * 3 / 2, fine);
  EXPECT_LT(fine * 3, statistics_.knots);
  EXPECT_LT(worstError(all, known), 1.0 / 1000);
}

TEST_F(MapsGpu, HomogeneousSmokeTakesOneNode) {
  KnownScene known{"block", {}, {}};
  known.scene.lights = {tests::directionalLight({0, -1, 0}, dvec3(1))};
  known.media = {tests::block({-1, 0, -1}, {1, 2, 1}, {4, 200, 4}, 1.0, dvec3(0.5), 0)};
  // The ramp of one voxel at its faces is worth 0.005 of transmittance, below this bound.
  const ReadMap map = build(known, 64, 1.0 / 128);
  for (size_t number = 0; number < map.texels.size(); ++number) {
    const auto [start, rate] = ray(map, number);
    if (std::abs(start.x) > 0.6 || std::abs(start.z) > 0.6) continue;
    EXPECT_EQ(map.texels[number].count, 2u) << number;
  }
}

TEST_F(MapsGpu, PanesAreExactColouredStepsBeforeInsideAndBehindSmoke) {
  for (const float height : {3.f, 1.f, -0.5f}) {
    KnownScene known{"pane", {}, {}};
    known.scene.lights = {tests::directionalLight({0, -1, 0}, dvec3(1))};
    known.media = {tests::block({-3, 0, -3}, {3, 2, 3}, {8, 8, 8}, 0.7, dvec3(0.5), 0)};
    tests::add(known.scene, tests::quad({-3, height, -3}, {6, 0, 0}, {0, 0, 6}),
               tests::pane({0.8f, 0.5f, 0.1f}));
    const ReadMap map = build(known, 64, 1.0 / 1024);
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
  const ReadMap map = build(known, 64, 1.0 / 512);
  size_t knots = 0;
  for (const shared::ShadowTexel& texel : map.texels) {
    for (size_t i = 0; i < texel.count; ++i) {
      ASSERT_LE(map.knots[texel.first + i].depth, texel.opaqueDepth * (1 + 1e-5));
      const size_t before = i == 0 ? i : i - 1;
      ASSERT_GE(map.knots[texel.first + i].depth, map.knots[texel.first + before].depth);
    }
    knots += texel.count;
  }
  EXPECT_EQ(knots, statistics_.knots);
  EXPECT_GT(knots, 0u);
}

TEST_F(MapsGpu, WindowsAndGrowingPoolsGiveTheSameFunctions) {
  // 1536 texels a side are built in three windows, and their knots outgrow the first pool.
  const KnownScene known = smokeUnder(tests::directionalLight({0.4, -1, 0.2}, dvec3(1)));
  const ReadMap map = build(known, 1536, 1.0 / 512, 0.5);
  EXPECT_GT(statistics_.lists.windows, 1);
  EXPECT_LT(worstError(map, known), 1.0 / 512 + 1.0 / 400);  // coarser steps than above
}

}  // namespace
}  // namespace sfumato::deepshadow
