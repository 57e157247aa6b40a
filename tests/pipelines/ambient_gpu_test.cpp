// Ambient light in the core pipeline: answers known beforehand, and the reference's.
#include "pipelines/pipeline_names.h"
#include "tests/pipelines/ambient_scenes.h"
#include "tests/pipelines/frame_test.h"
#include "tests/pipelines/pipeline_test.h"

namespace sfumato::pipelines {
namespace {

using tests::KnownScene;

constexpr int width = 96;
constexpr int height = 72;

class AmbientGpu : public FrameTest<width, height> {};

TEST_F(AmbientGpu, IsReflectedAsTheSurfaceIsColoured) {
  for (const tests::AmbientScene& of : tests::ambientScenes()) {
    SCOPED_TRACE(of.known.name);
    const image::Image image = draw(of.known, fine).radiance;
    // Exact but for the reflectance of 4 %, which a half rounds, and the march through smoke.
    const double tolerance = of.known.media.empty() ? 1e-5 : 1e-3;
    for (size_t i = 0; i < image.values.size(); ++i)
      ASSERT_NEAR(image.values[i], of.radiance[static_cast<int>(i % 3)], tolerance) << i;
  }
}

TEST_F(AmbientGpu, OfAWhitePlaneIsExactlyWhatArrives) {
  const tests::AmbientScene white = tests::ambientScenes().front();
  for (const int samples : {1, 4}) {
    Quality quality = fine;
    quality.samples = samples;
    for (const float value : draw(white.known, quality).radiance.values) ASSERT_EQ(value, 1.f);
  }
}

TEST_F(AmbientGpu, WithLightsIsThatOfTheReference) {
  for (const KnownScene& known : tests::ambientAndLights()) {
    const image::Image reference = referenceOf(known);
    const PixelErrors found = compareFrames("ambient_" + known.name, draw(known, fine).radiance, reference);
    // As for the same scenes without it: pixels at edges of shadows.
    EXPECT_LT(found.failingFraction, 0.005) << known.name;
    EXPECT_NEAR(found.meanRatio, 1.0, 0.001) << known.name;
  }
}

TEST_F(AmbientGpu, WithoutItTheReferenceIsNotMet) {
  KnownScene known = tests::shinySpheres();
  const image::Image dark = draw(known, fine).radiance;
  known.scene.ambient = glm::dvec3(0.05);
  const image::Image reference = referenceOf(known);
  EXPECT_GT(errors(dark, reference).failingFraction, 0.1);
}

TEST_F(AmbientGpu, AreTheSameInWindows) {
  const KnownScene known = tests::ambientAndLights()[1];
  EXPECT_EQ(draw(known, fine, {.windowPixels = 900}).radiance.values, draw(known, fine).radiance.values);
}

class AmbientInPipelines : public PipelineTest, public testing::WithParamInterface<std::string> {};

TEST_P(AmbientInPipelines, IsReflectedAsTheSurfaceIsColoured) {
  for (const tests::AmbientScene& of : tests::ambientScenes()) {
    SCOPED_TRACE(of.known.name);
    const double tolerance = of.known.media.empty() ? 1e-5 : 1e-3;
    const image::Image image = draw(GetParam(), of.known, fine, {width, height});
    for (size_t i = 0; i < image.values.size(); ++i)
      ASSERT_NEAR(image.values[i], of.radiance[static_cast<int>(i % 3)], tolerance) << i;
  }
}

TEST_P(AmbientInPipelines, IsKeptIn8Bits) {
  if (GetParam() == "lund") return;  // has no such storage
  const tests::AmbientScene coloured = tests::ambientScenes()[1];
  Quality quality = fine;
  quality.deferred.storage = Storage::Table;
  KnownScene known = coloured.known;
  known.scene.ambient = {0.5, 1, 0.25};
  const image::Image image = draw(GetParam(), known, quality, {width, height});
  const glm::dvec3 expected(0.25, 0.25, 0.25);
  for (size_t i = 0; i < image.values.size(); ++i)
    ASSERT_NEAR(image.values[i], expected[static_cast<int>(i % 3)], 0.01) << i;
}

INSTANTIATE_TEST_SUITE_P(Pipelines, AmbientInPipelines, testing::ValuesIn(pipelineNames()),
                         [](const auto& info) { return tests::testName(info.param); });

}  // namespace
}  // namespace sfumato::pipelines
