// The stencil-routed pipeline: the core pipeline's picture, whatever the samples, passes, pages and bands.
#include <string>

#include "image/metrics.h"
#include "pipelines/pipeline_gpu.h"
#include "pipelines/stencil_routed_gpu.h"
#include "tests/pipelines/known_scenes.h"
#include "tests/pipelines/pipeline_test.h"

namespace sfumato::pipelines {
namespace {

using tests::KnownScene;

class StencilRoutedGpu : public PipelineTest {};

class KnownScenesRouted : public StencilRoutedGpu, public testing::WithParamInterface<std::string> {};

TEST_P(KnownScenesRouted, AreTheListsPicture) {
  expectListsPicture("stencil-routed", tests::named(tests::knownScenes(), GetParam()), coarse());
}

INSTANTIATE_TEST_SUITE_P(KnownScenes, KnownScenesRouted,
                         testing::ValuesIn(tests::namesOf(tests::knownScenes())),
                         [](const auto& info) { return tests::testName(info.param); });

// `count` veils, each a little thinner than the last, drawn in an order that is none of depth; the further,
// the further left they begin, so that pixels differ in how many they have.
KnownScene manyVeils(int count) {
  KnownScene known{.name = "many_veils"};
  known.scene.cameras.push_back(tests::orthographicCamera({0, 0, 10}, {0, 0, 0}, 1));
  known.scene.lights.push_back(tests::directionalLight({0.2, -0.3, -1}, {3, 2, 1}));
  known.scene.lights.push_back(tests::pointLight({0.5, 0.5, 6}, {20, 30, 40}));
  tests::add(known.scene, tests::quad({-2, -2, -1}, {4, 0, 0}, {0, 4, 0}), tests::lambert({0.8, 0.8, 0.8}));
  for (scene::Light& light : known.scene.lights) light.castsShadow = count < 100;  // which would take long
  for (int i = 0; i < count; ++i) {
    const int place = (i * 97) % count;
    const float depth = static_cast<float>(place) / static_cast<float>(count);
    const glm::vec3 colour(depth, 1 - depth, 0.5f);
    tests::add(known.scene, tests::quad({-1.5f + depth, -2, 2 * depth}, {4, 0, 0}, {0, 4, 0}),
               tests::veil(colour, 0.004f + 0.001f * static_cast<float>(place % 7)));
  }
  return known;
}

TEST_F(StencilRoutedGpu, MorePassesKeepEveryVeil) {
  const KnownScene known = manyVeils(19);
  expectListsPicture("stencil-routed", known, coarse(), {48, 36});
}

TEST_F(StencilRoutedGpu, ThreeHundredLayersAreMoreThanAStencilCanCount) {
  expectListsPicture("stencil-routed", manyVeils(300), coarse(), {16, 12});
}

TEST_F(StencilRoutedGpu, EverySampleTakesOneFragmentInAPass) {
  const int most = routingOf(device()).samples;
  for (const int count : {1, 4, 19, 300}) {
    const KnownScene known = manyVeils(count);
    const glm::ivec2 size = count < 100 ? glm::ivec2(48, 36) : glm::ivec2(16, 12);
    StencilRoutedPipeline pipeline(device(), known.scene, known.media);
    const image::Image lists = draw("lund", known, coarse(), size);
    for (const int wanted : {1, 2, 0}) {
      SCOPED_TRACE(testing::Message() << count << " veils, " << wanted << " samples");
      Quality quality = coarse();
      quality.deferred.samples = wanted;
      const Frame frame = pipeline.render(known.scene.cameras[0], size.x, size.y, quality);
      EXPECT_LT(image::compare(frame.radiance, lists).relativeRmse, rounding);
      EXPECT_EQ(image::pixelsBeyond(frame.radiance, lists, 1e-4), 0u);
      const int samples = wanted > 0 ? std::min(wanted, most) : most;
      const int besides = 2;  // of what is opaque, and to count
      EXPECT_EQ(frame.statistics.geometryPasses, besides + (count + samples - 1) / samples);
    }
  }
}

TEST_F(StencilRoutedGpu, BandsShowTheSame) {
  const KnownScene known = tests::smokeAndGlass();
  const image::Image whole = draw("stencil-routed", known, coarse());
  Quality quality = coarse();
  quality.lists.budgetBytes = size_t{72} * 10 * 4 * 60;
  const image::Image inBands = draw("stencil-routed", known, quality);
  EXPECT_EQ(whole.values, inBands.values);
}

TEST_F(StencilRoutedGpu, TableStorageIsCloseAndSmaller) {
  const KnownScene known = tests::veilsOverWall();
  Quality quality = coarse();
  quality.deferred.storage = Storage::Table;
  const image::Image table = draw("stencil-routed", known, quality);
  const image::Image exact = draw("stencil-routed", known, coarse());
  const double error = image::compare(table, exact).relativeRmse;
  EXPECT_LT(error, 0.05);  // of 8 bits of light and colour
  EXPECT_GT(error, 0);
}

TEST_F(StencilRoutedGpu, ImagesOfAnySize) {
  const KnownScene known = tests::crossedPanes();
  for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(37, 23), glm::ivec2(4097, 3)}) {
    SCOPED_TRACE(size.x);
    expectListsPicture("stencil-routed", known, coarse(), size);
  }
}

}  // namespace
}  // namespace sfumato::pipelines
