// The stencil-routed pipeline: the core pipeline's picture, whatever the samples, passes, pages and bands.
#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <string>

#include "base/random.h"
#include "image/metrics.h"
#include "pipelines/pipeline_gpu.h"
#include "pipelines/stencil_routed_gpu.h"
#include "tests/pipelines/known_scenes.h"
#include "tests/pipelines/pipeline_test.h"

namespace sfumato::pipelines {
namespace {

using tests::KnownScene;

class StencilRoutedGpu : public PipelineTest {
 protected:
  // With samples of any number.
  void expectListsPictures(const KnownScene& known) {
    const image::Image lists = draw("lund", known, coarse());
    for (const int samples : {1, 2, 0}) {
      SCOPED_TRACE(testing::Message() << samples << " samples");
      Quality quality = coarse();
      quality.deferred.samples = samples;
      expectSame(draw("stencil-routed", known, quality), lists);
    }
  }

  static void expectSame(const image::Image& image, const image::Image& lists) {
    EXPECT_LT(image::compare(image, lists).relativeRmse, rounding);
    EXPECT_EQ(image::pixelsBeyond(image, lists, 1e-4), 0u);
  }
};

TEST_F(StencilRoutedGpu, RoutesToAllSamplesOfMesasSoftwareDriver) {
  if (device().names().renderer.find("llvmpipe") == std::string::npos) GTEST_SKIP() << "of llvmpipe only";
  EXPECT_EQ(routingOf(device()).samples, 4);
}

class KnownScenesRouted : public StencilRoutedGpu, public testing::WithParamInterface<std::string> {};

TEST_P(KnownScenesRouted, AreTheListsPicture) {
  expectListsPictures(tests::named(tests::knownScenes(), GetParam()));
}

INSTANTIATE_TEST_SUITE_P(KnownScenes, KnownScenesRouted,
                         testing::ValuesIn(tests::namesOf(tests::knownScenes())),
                         [](const auto& info) { return tests::testName(info.param); });

int addNoise(scene::Scene& scene, int side, uint64_t seed) {
  base::Random random(seed);
  scene::Texture texture{.name = "noise", .width = side, .height = side, .rgba = {}};
  for (int i = 0; i < side * side * 4; ++i)
    texture.rgba.push_back(static_cast<uint8_t>(random.uniform(64, 256)));
  scene.textures.push_back(std::move(texture));
  return static_cast<int>(scene.textures.size()) - 1;
}

TEST_F(StencilRoutedGpu, TexturesNormalsAndWhatIsBehindTheEye) {
  KnownScene known{.name = "textured_veils"};
  known.scene.cameras.push_back(tests::perspectiveCamera({0.2, 0.6, 4}, {0, 0.4, 0}, 0.9));
  known.scene.lights.push_back(tests::directionalLight({0.2, -1, -0.6}, {3, 2, 1}));
  known.scene.lights.push_back(tests::pointLight({0.5, 2.5, 3}, {20, 30, 40}));
  tests::add(known.scene, tests::quad({-6, -1, -4}, {12, 0, 0}, {0, 8, 0}), tests::lambert({0.8, 0.8, 0.8}));

  // Under the eye and on behind it; its texture is minified more and more.
  scene::Material floor = tests::veil({0.9f, 0.8f, 0.7f}, 0.6f);
  floor.baseColourTexture = {.texture = addNoise(known.scene, 64, 1), .textureFromUv = {6, 0, 0, 9, 0, 0}};
  floor.normalTexture = {.texture = addNoise(known.scene, 32, 2)};
  tests::add(known.scene, tests::quad({-3, 0, 9}, {6, 0, 0}, {0, 0.3f, -12}), floor);

  // One side is culled; its normals are those of a ball, its triangles' are not.
  scene::Material ball = tests::veil({0.5f, 0.7f, 0.9f}, 0.5f);
  ball.doubleSided = false;
  tests::add(known.scene, tests::sphere(6, 9), ball, glm::translate(glm::dmat4(1), {-0.9, 0.7, 0.5}));
  ball.doubleSided = true;
  tests::add(known.scene, tests::sphere(24, 48), ball, glm::translate(glm::dmat4(1), {1.1, 0.8, 0.2}));
  const image::Image lists = draw("lund", known, coarse());
  for (const int samples : {1, 2, 0}) {
    SCOPED_TRACE(testing::Message() << samples << " samples");
    Quality quality = coarse();
    quality.deferred.samples = samples;
    const image::Image routed = draw("stencil-routed", known, quality);
    // What is interpolated differs in its last bits, so that colours, which are kept as halves, may round the
    // other way here and there: by one part in 1,024.
    EXPECT_LT(image::compare(routed, lists).relativeRmse, 1e-4);
    EXPECT_EQ(image::pixelsBeyond(routed, lists, 1e-3), 0u);
  }
}

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
      expectSame(frame.radiance, lists);
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
