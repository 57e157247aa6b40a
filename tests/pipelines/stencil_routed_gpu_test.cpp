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

// `count` veils before a wall, each a triangle over the whole image, so that no driver has to make fragments
// at centres.
KnownScene wholeVeils(int count) {
  KnownScene known = manyVeils(count);
  for (scene::Mesh& mesh : known.scene.meshes) {
    const float z = mesh.vertices[0].position.z;
    mesh.vertices[0].position = {-4, -4, z};
    mesh.vertices[1].position = {12, -4, z};
    mesh.vertices[2].position = {-4, 12, z};
    mesh.indices = {0, 1, 2};
  }
  return known;
}

TEST_F(StencilRoutedGpu, EverySampleTakesOneFragmentInAPass) {
  for (const int count : {1, 4, 11, 300}) {
    const KnownScene known = wholeVeils(count);
    const image::Image lists = draw("lund", known, coarse(), {16, 12});
    for (const int samples : {2, 0}) {
      SCOPED_TRACE(testing::Message() << count << " veils, " << samples << " samples");
      Quality quality = coarse();
      quality.deferred.samples = samples;
      StencilRoutedPipeline pipeline(device(), known.scene, known.media);
      pipeline.coverWholePixels();
      const image::Image routed = pipeline.render(known.scene.cameras[0], 16, 12, quality).radiance;
      EXPECT_LT(image::compare(routed, lists).relativeRmse, 1e-5);
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
