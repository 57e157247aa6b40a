// The pictures of Lindbeck 2015 and the faults in them (its sections 2.2.4, 3.1 and 4): the GPU's frame
// against the CPU reference, and bounds on acne and leaks over light angles and shadow resolutions.
#include <fmt/format.h>

#include <cstdlib>
#include <numbers>

#include "image/image_file.h"
#include "image/metrics.h"
#include "tests/pipelines/frame_test.h"
#include "tests/pipelines/thesis_scenes.h"

namespace sfumato::pipelines {
namespace {

using tests::KnownScene;

constexpr double pi = std::numbers::pi;
constexpr int width = 64;
constexpr int height = 48;

class ThesisGpu : public FrameTest<width, height> {};

class ThesisScenesGpu : public ThesisGpu, public testing::WithParamInterface<std::string> {};

TEST_P(ThesisScenesGpu, LookLikeTheReference) {
  const KnownScene known = tests::named(tests::thesisScenes(), GetParam());
  Quality quality = fine;
  if (known.scene.lights.size() > 10)
    quality.shadowResolution = 512;  // the maps of 60 lights are 60 times as large
  // Near the camera a pane's shadow is a sharp edge in the smoke that both march over.
  if (known.name == "camera in smoke") quality.stepVoxels = 0.1;
  const Frame frame = draw(known, quality);
  const image::Image expected = referenceOf(known, {.stepVoxels = quality.stepVoxels});
  const PixelErrors found = compareFrames(known.name, frame.radiance, expected);
  // Edges of shadows fall between texels: the pixels on one may fail. Measured: 0.0051, and 0.0020 of the
  // mean.
  EXPECT_LT(found.failingFraction, 0.006);
  EXPECT_NEAR(found.meanRatio, 1.0, 0.003);
  EXPECT_EQ(frame.statistics.cutWalks, 0u);
}

INSTANTIATE_TEST_SUITE_P(Lindbeck2015, ThesisScenesGpu,
                         testing::ValuesIn(tests::namesOf(tests::thesisScenes())),
                         [](const auto& info) { return tests::testName(info.param); });

// Largest shortfall of a pixel, in units of what a surface that faces the light would send.
double worstShortfall(const image::Image& image, const image::Image& expected) {
  double worst = 0;
  for (size_t i = 0; i < image.values.size(); ++i)
    worst = std::max(worst, double(expected.values[i]) - double(image.values[i]));
  return worst / (3 / pi);
}

const std::vector<double> elevations = {0.02, 0.05, 0.1, 0.2, 0.35, 0.5, 0.7, 0.9, 1.1, 1.3, 1.5, pi / 2};
const std::vector<int> resolutions = {64, 128, 256, 512, 1024};

TEST_F(ThesisGpu, AFloorHasNoAcneAtAnyAngleAndResolution) {
  for (const double elevation : elevations) {
    const KnownScene known = tests::floorAtAngle(elevation);
    const image::Image expected = referenceOf(known);
    for (const int resolution : resolutions) {
      Quality quality = fine;
      quality.shadowResolution = resolution;
      EXPECT_LT(worstShortfall(draw(known, quality).radiance, expected), 1e-5)
          << "elevation " << elevation << ", " << resolution << " texels";
    }
  }
}

TEST_F(ThesisGpu, ABallHasNoAcneAtAnyAngleAndResolution) {
  for (const double elevation : elevations) {
    KnownScene known = tests::ballAtAngle(elevation);
    known.scene.instances.erase(known.scene.instances.begin());  // without the floor: nothing else shadows it
    const image::Image expected = referenceOf(known);
    for (const int resolution : resolutions) {
      Quality quality = fine;
      quality.shadowResolution = resolution;
      const double worst = worstShortfall(draw(known, quality).radiance, expected);
      // Measured: 0.017, beside the terminator.
      EXPECT_LT(worst, 0.025) << "elevation " << elevation << ", " << resolution << " texels";
    }
  }
}

TEST_F(ThesisGpu, NoLightLeaksIntoAClosedBox) {
  const scene::Light lights[] = {tests::directionalLight({0.3, -1, 0.2}, {100, 100, 100}),
                                 tests::directionalLight({1, -0.05, 0.02}, {100, 100, 100}),
                                 tests::pointLight({1.3, 0.4, 1.1}, {100, 100, 100}),
                                 tests::spotLight({-3, 3, 2}, {0, 1, 0}, {1000, 1000, 1000}, 0.5, 0.9)};
  for (const scene::Light& light : lights) {
    // Walls are thicker than two texels of any of these maps.
    const KnownScene known = tests::insideOfClosedBox(light, 0.2f);
    for (const int resolution : {128, 256, 512, 1024}) {
      for (const ShadowFilter filter : {ShadowFilter::Nearest, ShadowFilter::Bilinear, ShadowFilter::Soft}) {
        Quality quality = fine;
        quality.shadowResolution = resolution;
        quality.surfaceShadows = filter;
        const image::Image image = draw(known, quality).radiance;
        EXPECT_LT(*std::max_element(image.values.begin(), image.values.end()), 1e-3f)
            << "light " << static_cast<int>(light.type) << ", " << resolution << " texels, "
            << shadowFilters().nameOf(filter);
      }
    }
  }
}

// Walls without a thickness are as wide as their texels: what is within one of their outline may be lit.
TEST_F(ThesisGpu, LittleLightLeaksAlongTheOutlineOfThinWalls) {
  const KnownScene known =
      tests::insideOfClosedBox(tests::directionalLight({0.3, -1, 0.2}, {100, 100, 100}), 0);
  const image::Image image = draw(known, fine).radiance;
  const auto leaking =
      std::count_if(image.values.begin(), image.values.end(), [](float v) { return v > 1e-3f; });
  EXPECT_LT(leaking, 3 * width * height / 200);
}

TEST_F(ThesisGpu, NoLightLeaksOutOfAClosedBox) {
  for (const int resolution : resolutions) {
    Quality quality = fine;
    quality.shadowResolution = resolution;
    const image::Image image = draw(tests::outsideOfClosedBox(), quality).radiance;
    EXPECT_EQ(*std::max_element(image.values.begin(), image.values.end()), 0.f) << resolution << " texels";
  }
}

}  // namespace
}  // namespace sfumato::pipelines
