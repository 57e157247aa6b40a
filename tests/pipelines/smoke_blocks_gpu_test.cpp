// Smoke that is marched once for blocks of pixels, against the same frames at full resolution.
#include <fmt/format.h>

#include <cmath>

#include "image/metrics.h"
#include "pipelines/linked_lists_gpu.h"
#include "tests/gl/test_device.h"
#include "tests/pipelines/known_scenes.h"

namespace sfumato::pipelines {
namespace {

using tests::KnownScene;

constexpr int width = 128;
constexpr int height = 96;

class SmokeBlocksGpu : public tests::GpuTest {
 protected:
  Frame draw(const KnownScene& known, bool half, int samples = 1) {
    Quality quality;
    quality.samples = samples;
    quality.shadowResolution = 256;
    quality.halfResolutionSmoke = half;
    LinkedListsPipeline pipeline(device(), known.scene, known.media);
    return pipeline.render(known.scene.cameras[0], width, height, quality,
                           {.aovs = {Aov::Depth, Aov::Fragments}, .countLookups = true});
  }
};

// Dark bars at different depths in a ball of smoke before a bright wall: what is a pixel beside a bar shows
// far more smoke than the bar does.
KnownScene barsInSmoke() {
  KnownScene known;
  scene::Scene& scene = known.scene;
  tests::add(scene, tests::quad({-4, -4, -2}, {8, 0, 0}, {0, 8, 0}), tests::glowing({0.2f, 0.3f, 0.4f}));
  for (int i = 0; i < 7; ++i) {
    const float x = -0.9f + 0.29f * static_cast<float>(i), z = 0.25f * static_cast<float>(i % 5) - 0.5f;
    tests::add(scene, tests::quad({x, -1.2f, z}, {0.07f, 0, 0}, {0.3f, 2.4f, 0}),
               tests::lambert({0.02f, 0.02f, 0.02f}));
  }
  known.media.push_back(tests::ball({0, 0, 0}, 1, 48, 4, {0.9, 0.9, 0.9}, 0));
  scene.lights.push_back(tests::directionalLight({1, -2, -3}, {6, 5, 4}));
  scene.cameras.push_back(tests::perspectiveCamera({0, 0, 3}, {0, 0, 0}, 0.65));
  return known;
}

// Whether a pixel's depth differs from that of one beside it by more than a tenth of a metre.
bool isAtEdge(const image::Image& depth, int x, int y) {
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const int atX = std::clamp(x + dx, 0, width - 1), atY = std::clamp(y + dy, 0, height - 1);
      if (std::abs(depth.pixel(atX, atY)[0] - depth.pixel(x, y)[0]) > 0.1f) return true;
    }
  return false;
}

// Largest difference at edges of depth, over the mean of the second image.
double worstAtEdges(const image::Image& a, const image::Image& b, const image::Image& depth) {
  double worst = 0, sum = 0;
  for (const float value : b.values) sum += value;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int channel = 0; channel < 3; ++channel)
        if (isAtEdge(depth, x, y))
          worst =
              std::max(worst, static_cast<double>(std::abs(a.pixel(x, y)[channel] - b.pixel(x, y)[channel])));
  return worst * static_cast<double>(b.values.size()) / sum;
}

// Every pixel the mean of its block: half resolution that knows nothing of depth.
image::Image blurred(const image::Image& image) {
  image::Image result = image;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int channel = 0; channel < 3; ++channel) {
        float sum = 0;
        for (int i = 0; i < 4; ++i) sum += image.pixel(x / 2 * 2 + i % 2, y / 2 * 2 + i / 2)[channel];
        result.pixel(x, y)[channel] = sum / 4;
      }
  return result;
}

TEST_F(SmokeBlocksGpu, LeaveNoHaloAtEdgesOfDepth) {
  KnownScene known = barsInSmoke();
  // The bars' shadows have edges in the smoke, which half resolution blurs wherever they are.
  EXPECT_LT(image::compare(draw(known, true).radiance, draw(known, false).radiance).relativeRmse, 0.01);
  known.scene.lights[0].castsShadow = false;
  const Frame full = draw(known, false), half = draw(known, true);
  const image::Image& depth = full.aovs.at(Aov::Depth);
  const double error = image::compare(half.radiance, full.radiance).relativeRmse;
  const double atEdges = worstAtEdges(half.radiance, full.radiance, depth);
  const double ofBlurring = worstAtEdges(blurred(full.radiance), full.radiance, depth);
  fmt::print("relative RMSE {:.5f}; at edges {:.4f} of the mean at most, blind averaging {:.4f}\n", error,
             atEdges, ofBlurring);
  EXPECT_LT(error, 0.005);
  // Measured 0.051: bars of five pixels, whose blocks look half a pixel past what they stand for.
  EXPECT_LT(atEdges, 0.06);
  EXPECT_GT(ofBlurring, 10 * atEdges);
  EXPECT_GT(error, 0.0);
}

TEST_F(SmokeBlocksGpu, SpareMostLookups) {
  KnownScene known = barsInSmoke();
  known.media[0] =
      tests::ball({0, 0, 0}, 1, 48, 1, {0.9, 0.9, 0.9}, 0);  // thin: nothing is refined but edges
  const Lookups full = draw(known, false).statistics.lookups, half = draw(known, true).statistics.lookups;
  EXPECT_LT(half.steps, full.steps / 2);
  EXPECT_LT(half.shadows, full.shadows / 2);
}

// A wall that leans through the smoke, and one far behind it; the camera stands in it where `within`.
KnownScene wallThroughSmoke(bool within) {
  KnownScene known;
  scene::Scene& scene = known.scene;
  tests::add(scene, tests::quad({-4, -4, -4}, {8, 0, 0}, {0, 8, 0}), tests::glowing({0.2f, 0.3f, 0.4f}));
  tests::add(scene, tests::quad({-0.6f, -0.8f, 0.9f}, {1.2f, 0, -1.6f}, {0, 1.6f, -0.2f}),
             tests::lambert({0.5f, 0.4f, 0.3f}));
  known.media.push_back(tests::ball({0, 0, 0}, 1, 48, 4, {0.9, 0.9, 0.9}, 0.3));
  scene.lights.push_back(tests::directionalLight({1, -2, -3}, {6, 5, 4}));
  scene.lights.push_back(tests::pointLight({0.9, 0.5, 1.2}, {3, 4, 5}));
  scene.cameras.push_back(tests::perspectiveCamera({0, 0, within ? 0.7 : 3}, {0, 0, 0}, 0.65));
  return known;
}

TEST_F(SmokeBlocksGpu, TellOfSmokeUpToASurfaceInIt) {
  for (const bool within : {false, true}) {
    const KnownScene known = wallThroughSmoke(within);
    KnownScene clear = known;
    clear.media.clear();
    const Frame full = draw(known, false), half = draw(known, true);
    const double error = image::compare(half.radiance, full.radiance).relativeRmse;
    const double ofNoSmoke = image::compare(draw(clear, false).radiance, full.radiance).relativeRmse;
    fmt::print("{}: relative RMSE {:.5f}, without smoke {:.3f}\n", within ? "within" : "before", error,
               ofNoSmoke);
    EXPECT_LT(error, 0.01);
    EXPECT_GT(ofNoSmoke, 0.2);
  }
}

TEST_F(SmokeBlocksGpu, TellOfSmokeBetweenPanesAndToSamples) {
  const KnownScene known = tests::smokeAndGlass();
  const Frame full = draw(known, false, 4), half = draw(known, true, 4);
  const image::Image& fragments = full.aovs.at(Aov::Fragments);
  double worstBehindPanes = 0;
  long behindPanes = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      if (fragments.pixel(x, y)[0] == 0) continue;
      ++behindPanes;
      for (int channel = 0; channel < 3; ++channel)
        worstBehindPanes = std::max<double>(worstBehindPanes, std::abs(full.radiance.pixel(x, y)[channel] -
                                                                       half.radiance.pixel(x, y)[channel]));
    }
  fmt::print("behind {} panes: off by {:.4f} at most\n", behindPanes, worstBehindPanes);
  EXPECT_GT(behindPanes, 100);
  EXPECT_GT(worstBehindPanes, 0);  // they are interpolated, too
  EXPECT_LT(image::compare(half.radiance, full.radiance).relativeRmse, 0.01);
}

TEST_F(SmokeBlocksGpu, GoOnWhereADispatchEnds) {
  const KnownScene known = wallThroughSmoke(false);
  Quality quality;
  quality.samples = 1;
  quality.shadowResolution = 64;
  LinkedListsPipeline pipeline(device(), known.scene, known.media);
  const auto errorWithSteps = [&](double voxels) {
    quality.stepVoxels = voxels;
    quality.halfResolutionSmoke = false;
    const image::Image full = pipeline.render(known.scene.cameras[0], 32, 24, quality).radiance;
    quality.halfResolutionSmoke = true;
    const image::Image half = pipeline.render(known.scene.cameras[0], 32, 24, quality).radiance;
    return image::compare(half, full).relativeRmse;
  };
  EXPECT_LT(errorWithSteps(0.5), 0.005);
  EXPECT_LT(errorWithSteps(0.02), 0.005);  // some 2,400 steps of the ball, each of them lit twice
}

TEST_F(SmokeBlocksGpu, OfFourPixelsASideAreCloseWhereVoxelsAreWide) {
  KnownScene known = wallThroughSmoke(false);
  known.media[0] = tests::ball({0, 0, 0}, 1, 12, 0.5, {0.9, 0.9, 0.9}, 0.3);
  Quality quality;
  quality.samples = 1;
  quality.shadowResolution = 256;
  LinkedListsPipeline pipeline(device(), known.scene, known.media);
  const auto drawn = [&] {
    return pipeline.render(known.scene.cameras[0], width, height, quality, {.countLookups = true});
  };
  const Frame full = drawn();
  quality.smokeRaySpacing = 1;
  const Frame apart = drawn();
  const double error = image::compare(apart.radiance, full.radiance).relativeRmse;
  fmt::print("relative RMSE {:.5f}\n", error);
  EXPECT_LT(apart.statistics.lookups.steps, full.statistics.lookups.steps / 3);  // edges take more
  EXPECT_LT(error, 0.02);
}

TEST_F(SmokeBlocksGpu, OfTilesAndWindowsShowTheSame) {
  const KnownScene known = wallThroughSmoke(false);
  Quality quality;
  quality.samples = 1;
  quality.halfResolutionSmoke = true;
  LinkedListsPipeline pipeline(device(), known.scene, known.media);
  const auto drawn = [&](const FrameOptions& options) {
    return pipeline.render(known.scene.cameras[0], 61, 45, quality, options).radiance;
  };
  const image::Image whole = drawn({});
  // Blocks of another part are not asked at its border.
  EXPECT_LT(image::compare(drawn({.tilePixels = 1000}), whole).relativeRmse, 0.005);
  EXPECT_LT(image::compare(drawn({.windowPixels = 700}), whole).relativeRmse, 0.005);
}

TEST_F(SmokeBlocksGpu, ChangeNothingWithoutSmoke) {
  const KnownScene known = tests::planeUnderSpotLight();
  EXPECT_EQ(draw(known, true).radiance.values, draw(known, false).radiance.values);
}

}  // namespace
}  // namespace sfumato::pipelines
