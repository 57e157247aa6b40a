// Ambient light in the core pipeline: answers known beforehand, and the reference's.
#include "pipelines/linked_lists_gpu.h"
#include "pipelines/pipeline_gpu.h"
#include "pipelines/pipeline_names.h"
#include "pipelines/reference.h"
#include "tests/gl/test_device.h"
#include "tests/pipelines/ambient_scenes.h"
#include "tests/pipelines/frame_errors.h"

namespace sfumato::pipelines {
namespace {

using tests::KnownScene;

constexpr int width = 96;
constexpr int height = 72;

class AmbientGpu : public tests::GpuTest {
 protected:
  image::Image draw(const KnownScene& known, const Quality& quality) {
    LinkedListsPipeline pipeline(device(), known.scene, known.media);
    return pipeline.render(known.scene.cameras[0], width, height, quality).radiance;
  }
};

TEST_F(AmbientGpu, IsReflectedAsTheSurfaceIsColoured) {
  for (const tests::AmbientScene& of : tests::ambientScenes()) {
    SCOPED_TRACE(of.known.name);
    const image::Image image = draw(of.known, fine);
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
    for (const float value : draw(white.known, quality).values) ASSERT_EQ(value, 1.f);
  }
}

TEST_F(AmbientGpu, WithLightsIsThatOfTheReference) {
  for (const KnownScene& known : tests::ambientAndLights()) {
    const image::Image reference =
        renderReference(known.scene, known.scene.cameras[0], known.media, {.width = width, .height = height});
    const PixelErrors found = compareFrames("ambient_" + known.name, draw(known, fine), reference);
    // As for the same scenes without it: pixels at edges of shadows.
    EXPECT_LT(found.failingFraction, 0.005) << known.name;
    EXPECT_NEAR(found.meanRatio, 1.0, 0.001) << known.name;
  }
}

TEST_F(AmbientGpu, WithoutItTheReferenceIsNotMet) {
  KnownScene known = tests::shinySpheres();
  const image::Image dark = draw(known, fine);
  known.scene.ambient = glm::dvec3(0.05);
  const image::Image reference =
      renderReference(known.scene, known.scene.cameras[0], known.media, {.width = width, .height = height});
  EXPECT_GT(errors(dark, reference).failingFraction, 0.1);
}

TEST_F(AmbientGpu, AreTheSameInWindows) {
  const KnownScene known = tests::ambientAndLights()[1];
  LinkedListsPipeline pipeline(device(), known.scene, known.media);
  const auto draw = [&](const FrameOptions& options) {
    return pipeline.render(known.scene.cameras[0], width, height, fine, options).radiance;
  };
  EXPECT_EQ(draw({.windowPixels = 900}).values, draw({}).values);
}

class AmbientInPipelines : public AmbientGpu, public testing::WithParamInterface<std::string> {
 protected:
  image::Image drawBy(const std::string& name, const KnownScene& known, const Quality& quality) {
    return makePipeline(name, device(), known.scene, known.media)
        ->render(known.scene.cameras[0], width, height, quality)
        .radiance;
  }
};

TEST_P(AmbientInPipelines, IsReflectedAsTheSurfaceIsColoured) {
  for (const tests::AmbientScene& of : tests::ambientScenes()) {
    SCOPED_TRACE(of.known.name);
    const double tolerance = of.known.media.empty() ? 1e-5 : 1e-3;
    const image::Image image = drawBy(GetParam(), of.known, fine);
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
  const image::Image image = drawBy(GetParam(), known, quality);
  const glm::dvec3 expected(0.25, 0.25, 0.25);
  for (size_t i = 0; i < image.values.size(); ++i)
    ASSERT_NEAR(image.values[i], expected[static_cast<int>(i % 3)], 0.01) << i;
}

INSTANTIATE_TEST_SUITE_P(Pipelines, AmbientInPipelines, testing::ValuesIn(pipelineNames()),
                         [](const auto& info) { return tests::testName(info.param); });

}  // namespace
}  // namespace sfumato::pipelines
