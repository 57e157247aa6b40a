// The core pipeline against the CPU reference and known answers.
#include "pipelines/linked_lists_gpu.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>

#include "image/image_file.h"
#include "image/metrics.h"
#include "scene/gltf.h"
#include "scene/media.h"
#include "tests/pipelines/frame_test.h"

namespace sfumato::pipelines {
namespace {

using tests::KnownScene;

constexpr int width = 96;
constexpr int height = 72;

class LinkedListsGpuFrames : public FrameTest<width, height> {};

class LinkedListsGpu : public LinkedListsGpuFrames, public testing::WithParamInterface<std::string> {};

TEST_P(LinkedListsGpu, DrawsWhatTheReferenceDraws) {
  const KnownScene known = tests::named(tests::knownScenes(), GetParam());
  const Frame frame = draw(known, fine);
  const image::Image reference = referenceOf(known);
  const PixelErrors found = compareFrames(known.name, frame.radiance, reference);
  // Shadow edges fall between texels: a few pixels lie on one. Measured: 0.0020 and 0.0004 at most.
  EXPECT_LT(found.failingFraction, 0.005);
  EXPECT_NEAR(found.meanRatio, 1.0, 0.001);
  EXPECT_EQ(frame.statistics.cutWalks, 0u);
}

// Drivers end all loops of an invocation after 65,535 iterations, and say nothing.
TEST_F(LinkedListsGpuFrames, MoreLightsOfAPointThanDriversSurelyLoopOverAreTold) {
  KnownScene known = tests::paneBeforeSmoke();
  const scene::Light light = tests::pointLight({1, 1, 1}, glm::dvec3(1e-3));
  for (const auto& [lights, told] : {std::pair(1000, false), std::pair(2000, true)}) {
    known.scene.lights.assign(static_cast<size_t>(lights), light);
    for (scene::Light& each : known.scene.lights) each.castsShadow = false;
    Quality quality = qualityNamed("draft");
    quality.samples = 1;
    EXPECT_EQ(draw(known, quality).statistics.cutWalks > 0, told) << lights;
  }
}

TEST_F(LinkedListsGpuFrames, SamplesSmoothEdges) {
  // Against 8 x 8 rays a pixel: four samples leave a fraction of the error of one.
  // Without shadows: their edges are as smooth as the maps' texels.
  KnownScene known = tests::smokeAndGlass();
  for (scene::Light& light : known.scene.lights) light.castsShadow = false;
  const image::Image reference = referenceOf(known, {.samples = 8, .stepVoxels = 1, .shadowStepVoxels = 1});
  Quality quality = fine;
  const double rough = image::compare(draw(known, quality).radiance, reference).relativeRmse;
  quality.samples = 4;
  const Frame smooth = draw(known, quality);
  const double smoothed = image::compare(smooth.radiance, reference).relativeRmse;
  fmt::print("relative RMSE with 1 sample {:.4f}, with 4 {:.4f}, {} pixels split\n", rough, smoothed,
             smooth.statistics.splitPixels);
  EXPECT_LT(smoothed, 0.6 * rough);
  EXPECT_GT(smooth.statistics.splitPixels, 0u);
  EXPECT_LT(smooth.statistics.splitPixels, static_cast<size_t>(width * height / 4));
}

TEST_F(LinkedListsGpuFrames, FlatSurfacesAreNotSplit) {
  Quality quality = fine;
  quality.samples = 4;
  EXPECT_EQ(draw(tests::planeUnderPointLight(), quality).statistics.splitPixels, 0u);
}

TEST_F(LinkedListsGpuFrames, AreTheSameBitsEveryTime) {
  const KnownScene known = tests::smokeAndGlass();
  Quality quality = fine;
  quality.samples = 4;
  quality.shadowResolution = 256;
  const image::Image first = draw(known, quality).radiance;
  for (int i = 0; i < 3; ++i) EXPECT_EQ(draw(known, quality).radiance.values, first.values);
}

TEST_F(LinkedListsGpuFrames, LongWalksGoOnInFurtherDispatches) {
  // Steps so short that a ray does more work than one dispatch allows; the picture stays the same.
  const KnownScene known = tests::paneBeforeSmoke();
  Quality quality = fine;
  quality.shadowResolution = 64;
  quality.stepVoxels = 0.2;
  const Frame whole = draw(known, quality);
  quality.stepVoxels = 0.0005;
  LinkedListsPipeline pipeline(device(), known.scene, known.media);
  const Frame pieces = pipeline.render(known.scene.cameras[0], 16, 12, quality);
  quality.stepVoxels = 0.2;
  const Frame few = pipeline.render(known.scene.cameras[0], 16, 12, quality);
  EXPECT_EQ(whole.statistics.resolveDispatches, 1);
  EXPECT_GT(pieces.statistics.resolveDispatches, 1);
  EXPECT_LT(image::compare(pieces.radiance, few.radiance).relativeRmse, 0.002);
}

// The smoke and glass with edges, split pixels and lists that tiles and windows cut.
Frame drawInParts(gl::Device& device, const FrameOptions& options) {
  const KnownScene known = tests::smokeAndGlass();
  LinkedListsPipeline pipeline(device, known.scene, known.media);
  Quality quality = fine;
  quality.samples = 4;
  quality.shadowResolution = 256;
  return pipeline.render(known.scene.cameras[0], width, height, quality, options);
}

TEST_F(LinkedListsGpuFrames, WindowsAreSeenNowhere) {
  const Frame whole = drawInParts(device(), {});
  for (const size_t windowPixels : {5000u, 900u, 7u}) {
    const Frame parts = drawInParts(device(), {.windowPixels = windowPixels});
    EXPECT_EQ(parts.radiance.values, whole.radiance.values) << windowPixels;
    EXPECT_EQ(parts.statistics.tiles, 1u);
    EXPECT_GE(static_cast<size_t>(parts.statistics.surfaces.windows) * windowPixels, width * height);
    EXPECT_EQ(parts.statistics.surfaces.cells, whole.statistics.surfaces.cells);
    EXPECT_EQ(parts.statistics.surfaces.demand, whole.statistics.surfaces.demand);
    EXPECT_EQ(parts.statistics.splitPixels, whole.statistics.splitPixels);
  }
}

// Where a tile begins decides how the rasteriser rounds: depths and normals by a last bit, and now and then a
// sample on an edge. Measured on llvmpipe: at most one pixel of 6912.
TEST_F(LinkedListsGpuFrames, TilesAreSeenNowhere) {
  const Frame whole = drawInParts(device(), {});
  for (const size_t tilePixels : {5000u, 900u, 200u}) {
    size_t done = 0;
    const Frame parts = drawInParts(device(), {.tilePixels = tilePixels, .onTile = [&] { ++done; }});
    EXPECT_EQ(parts.statistics.tiles, tilesOf(width, height, tilePixels).size());
    EXPECT_EQ(done, parts.statistics.tiles);
    EXPECT_EQ(parts.statistics.surfaces.cells, whole.statistics.surfaces.cells);
    EXPECT_LE(image::pixelsBeyond(parts.radiance, whole.radiance, 1e-5), 4u) << tilePixels;
  }
}

// A red wall a centimetre before a blue one, far away, seen through a near plane that is all but in the eye.
TEST_F(LinkedListsGpuFrames, TellsSurfacesApartWhateverTheNearPlane) {
  for (const double nearDistance : {0.1, 1e-6, 1e-300}) {
    KnownScene known;
    const auto wall = [&](float z, const glm::vec3& colour) {
      tests::add(known.scene, tests::quad({-200, -200, z}, {400, 0, 0}, {0, 400, 0}), tests::glowing(colour));
    };
    wall(-0.01f, {1, 0, 0});
    wall(-0.02f, {0, 0, 1});
    known.scene.cameras = {tests::perspectiveCamera({0, 0, 100}, {0, 0, 0}, 0.8)};
    known.scene.cameras[0].nearDistance = nearDistance;
    const Frame frame = draw(known, fine);
    for (size_t i = 0; i < frame.radiance.values.size(); ++i)
      ASSERT_EQ(frame.radiance.values[i], i % 3 == 0 ? 1.f : 0.f) << nearDistance;
  }
}

TEST_F(LinkedListsGpuFrames, WindowsAreHalvedUntilTheirListsFit) {
  // 13 veils over 512 x 512 pixels: 3.4 million nodes of 48 bytes.
  KnownScene known;
  for (int i = 0; i < 13; ++i)
    tests::add(known.scene, tests::quad({-2, -2, -0.1f * static_cast<float>(i)}, {4, 0, 0}, {0, 4, 0}),
               tests::veil({1, 1, 1}, 0.0625f));
  tests::add(known.scene, tests::quad({-2, -2, -2}, {4, 0, 0}, {0, 4, 0}), tests::glowing({1, 2, 3}));
  const scene::Camera camera = tests::orthographicCamera({0, 0, 1}, {0, 0, 0}, 1);
  LinkedListsPipeline pipeline(device(), known.scene, known.media);
  Quality quality = fine;
  quality.lists.budgetBytes = 16 << 20;
  const Frame frame = pipeline.render(camera, 512, 512, quality);
  EXPECT_GE(frame.statistics.surfaces.windows, 10);
  EXPECT_LE(frame.statistics.surfaces.bytes, quality.lists.budgetBytes);
  EXPECT_EQ(frame.statistics.surfaces.demand, 13u * 512 * 512);
  EXPECT_EQ(frame.statistics.surfaces.cells, 512u * 512);
  const double seen = std::pow(0.9375, 13);
  for (size_t i = 0; i < frame.radiance.values.size(); ++i)
    ASSERT_NEAR(frame.radiance.values[i], seen * static_cast<double>(i % 3 + 1), 1e-5) << i;
}

// In thin homogeneous smoke the light of a lamp grows without bound towards it, and its mean over a pixel
// does not: the integral over the square of the pixel, cut finely, of the ray's, told as an angle about the
// lamp.
TEST_F(LinkedListsGpuFrames, LampsInSmokeShineAsTheirIntegral) {
  constexpr double sigmaT = 1e-3, g = 0.5, intensity = 1000, pixel = 1.0 / height;
  KnownScene known;
  known.media.push_back(tests::block({-1, -1, -1}, {1, 1, 1}, {16, 16, 16}, sigmaT, {1, 1, 1}, g));
  const glm::dvec2 lamp(0.3 * pixel, -1.1 * pixel);
  known.scene.lights.push_back(tests::pointLight({lamp, 0}, glm::dvec3(intensity)));
  known.scene.cameras.push_back(tests::orthographicCamera({0, 0, 2}, {0, 0, 0}, 0.5));
  const Frame frame = draw(known, fine);

  const auto alongRay = [&](double passed) {
    constexpr int cuts = 64;
    const double widest = std::atan(1 / passed);
    double sum = 0;
    for (int i = 0; i < cuts; ++i) {
      const double cosine = std::sin(widest * (2 * (i + 0.5) / cuts - 1));
      sum += (1 - g * g) / (4 * std::numbers::pi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
    }
    return sigmaT * intensity * sum * 2 * widest / (cuts * passed);
  };
  for (int y = height / 2 - 4; y < height / 2 + 4; ++y)
    for (int x = width / 2 - 4; x < width / 2 + 4; ++x) {
      constexpr int side = 32;
      double expected = 0;
      for (int i = 0; i < side * side; ++i) {
        const glm::dvec2 within((i % side + 0.5) / side, (i / side + 0.5) / side);
        const glm::dvec2 p = pixel * (glm::dvec2(x - width / 2, height / 2 - y - 1) + within);
        expected += alongRay(glm::distance(p, lamp)) / (side * side);
      }
      EXPECT_NEAR(frame.radiance.pixel(x, y)[0], expected, 0.015 * expected) << x << " " << y;
    }
}

// The folder that SFUMATO_TRUTH names holds scenes with pictures of an independent path tracer.
class TruthGpu : public tests::GpuTest, public testing::WithParamInterface<const char*> {};

TEST_P(TruthGpu, IsMetAtMediumAndHighQuality) {
  const char* folder = std::getenv("SFUMATO_TRUTH");
  if (folder == nullptr) GTEST_SKIP() << "SFUMATO_TRUTH names no folder of scenes with an outside answer";
  const std::filesystem::path base = std::filesystem::path(folder) / GetParam();
  const scene::Scene scene = scene::readGltf(base.string() + ".gltf");
  const image::Image truth = image::readImage(base.string() + ".exr");
  const auto media = scene::readMedia(scene);
  LinkedListsPipeline pipeline(device(), scene, media);
  for (const auto& [quality, bound] : {std::pair("medium", 0.015), std::pair("high", 0.012)}) {
    const Frame frame =
        pipeline.render(scene.cameras[0], truth.width * 5, truth.height * 5, qualityNamed(quality));
    const image::Difference difference = image::compare(image::averageDown(frame.radiance, 5), truth);
    fmt::print("{} {}: relative RMSE {:.5f}, mean ratio {:.5f}\n", GetParam(), quality,
               difference.relativeRmse, difference.meanRatio);
    EXPECT_LT(difference.relativeRmse, bound) << quality;
    EXPECT_NEAR(difference.meanRatio, 1.0, 0.005) << quality;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, TruthGpu, testing::Values("two_lights", "sun"));

INSTANTIATE_TEST_SUITE_P(KnownScenes, LinkedListsGpu, testing::ValuesIn(tests::namesOf(tests::knownScenes())),
                         [](const auto& info) { return tests::testName(info.param); });

}  // namespace
}  // namespace sfumato::pipelines
