// What all ways to draw a frame have in common, and where they must give the same picture.
#include "image/metrics.h"
#include "pipelines/linked_lists_gpu.h"
#include "pipelines/pipeline_gpu.h"
#include "pipelines/pipeline_names.h"
#include "tests/gl/test_device.h"
#include "tests/pipelines/frame_errors.h"
#include "tests/pipelines/known_scenes.h"

namespace sfumato::pipelines {
namespace {

using tests::KnownScene;

constexpr int width = 96;
constexpr int height = 72;

// What pipelines share need not be fine to be the same.
Quality coarse() {
  Quality quality = fine;
  quality.shadowResolution = 128;
  quality.stepVoxels = 2;
  return quality;
}

class PipelinesGpu : public tests::GpuTest {
 protected:
  image::Image draw(const std::string& name, const KnownScene& known, const Quality& quality) {
    return makePipeline(name, device(), known.scene, known.media)
        ->render(known.scene.cameras[0], width, height, quality)
        .radiance;
  }
};

class KnownScenesInPipelines : public PipelinesGpu, public testing::WithParamInterface<std::string> {};

TEST_P(KnownScenesInPipelines, PeelingAllLayersIsTheListsPicture) {
  const KnownScene known = tests::named(tests::knownScenes(), GetParam());
  const image::Image lists = draw("lund", known, coarse());
  const image::Image peeled = draw("peeling", known, coarse());
  // The same surfaces, lights and steps; sums are rounded in another order.
  EXPECT_LT(image::compare(peeled, lists).relativeRmse, 1e-5);
  EXPECT_EQ(image::pixelsBeyond(peeled, lists, 1e-4), 0u);
}

INSTANTIATE_TEST_SUITE_P(KnownScenes, KnownScenesInPipelines,
                         testing::ValuesIn(tests::namesOf(tests::knownScenes())),
                         [](const auto& info) { return tests::testName(info.param); });

}  // namespace
}  // namespace sfumato::pipelines
