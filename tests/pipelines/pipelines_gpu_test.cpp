// What all ways to draw a frame have in common, and where they must give the same picture.
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "pipelines/pipeline_names.h"
#include "tests/pipelines/known_scenes.h"
#include "tests/pipelines/pipeline_test.h"

namespace sfumato::pipelines {
namespace {

using tests::KnownScene;

constexpr int width = 72;
constexpr int height = 54;
using PipelinesGpu = PipelineTest;

class KnownScenesInPipelines : public PipelinesGpu, public testing::WithParamInterface<std::string> {};

TEST_P(KnownScenesInPipelines, PeelingAllLayersIsTheListsPicture) {
  const KnownScene known = tests::named(tests::knownScenes(), GetParam());
  const image::Image lists = draw("lund", known, coarse());
  EXPECT_LT(image::compare(draw("peeling", known, coarse()), lists).relativeRmse, rounding);
}

TEST_P(KnownScenesInPipelines, ForwardIsInterlaced) {
  const KnownScene known = tests::named(tests::knownScenes(), GetParam());
  const image::Image interlaced = draw("interlaced", known, coarse());
  // Forward renderers keep what surfaces let through in halves, and normals in 10 bits.
  for (const char* name : {"forward", "forward-mask"})
    EXPECT_LT(image::compare(draw(name, known, coarse()), interlaced).relativeRmse, rounding) << name;
}

INSTANTIATE_TEST_SUITE_P(KnownScenes, KnownScenesInPipelines,
                         testing::ValuesIn(tests::namesOf(tests::knownScenes())),
                         [](const auto& info) { return tests::testName(info.param); });

class EveryPipeline : public PipelinesGpu, public testing::WithParamInterface<std::string> {};

TEST_P(EveryPipeline, DrawsOpaqueSurfacesAsTheListsDo) {
  for (const KnownScene& known : {tests::planeUnderPointLight(), tests::planeUnderSpotLight(),
                                  tests::shinySpheres(), tests::smokeOverFloor()})
    EXPECT_LT(image::compare(draw(GetParam(), known, coarse()), draw("lund", known, coarse())).relativeRmse,
              rounding)
        << known.name;
}

TEST_P(EveryPipeline, HasTheSameAmbientLight) {
  KnownScene known = tests::shinySpheres();
  known.scene.ambient = {0.5, 1, 0.25};
  Quality quality = coarse();
  quality.ambientOcclusion = {OcclusionSize::Half, 0.5};
  const image::Image lists = draw("lund", known, quality);
  EXPECT_LT(image::compare(draw(GetParam(), known, quality), lists).relativeRmse, rounding);
  quality.ambientOcclusion = {};
  EXPECT_GT(image::compare(draw(GetParam(), known, quality), lists).relativeRmse, 100 * rounding);
}

// Small lights whose meshes the camera sees from outside, from within, and cut by the near plane.
TEST_P(EveryPipeline, MeetsLightsFromOutsideAndWithin) {
  KnownScene known;
  tests::add(known.scene, tests::quad({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}), tests::lambert({0.8f, 0.6f, 0.4f}));
  for (const double x : {-1.5, 0.0, 1.5}) {
    scene::Light light = tests::pointLight({x, 0.4, 0}, {1, 2, 3});
    light.range = 0.9;
    known.scene.lights.push_back(light);
    light = tests::spotLight({x, 1, 1}, {x + 0.5, 0, 1}, {3, 2, 1}, 0.2, 0.4);
    light.range = 2;
    known.scene.lights.push_back(light);
  }
  for (const glm::dvec3& eye : {glm::dvec3(0, 3, 5), glm::dvec3(0, 0.5, 0.5), glm::dvec3(1.5, 0.95, 1),
                                glm::dvec3(0, 0.4, 0.9), glm::dvec3(0.1, 0.9, 1.4)}) {
    known.scene.cameras = {tests::perspectiveCamera(eye, {0.3, 0, -0.2}, 0.9)};
    expectListsPicture(GetParam(), known, coarse());
    known.scene.cameras = {tests::orthographicCamera(eye, {0.3, 0, -0.2}, 1)};
    expectListsPicture(GetParam(), known, coarse());
  }
}

TEST_P(EveryPipeline, DrawsImagesOfAnySize) {
  const KnownScene known = tests::smokeAndGlass();
  Quality quality = coarse();
  quality.shadowResolution = 32;
  const auto pipeline = makePipeline(GetParam(), device(), known.scene, known.media);
  for (const glm::ivec2 size :
       {glm::ivec2(1, 1), glm::ivec2(4097, 3), glm::ivec2(1, 2), glm::ivec2(33, 17)}) {
    const image::Image image = pipeline->render(known.scene.cameras[0], size.x, size.y, quality).radiance;
    EXPECT_EQ(glm::ivec2(image.width, image.height), size);
    EXPECT_EQ(image::findNotFinite(image).count, 0u);
    EXPECT_GT(*std::max_element(image.values.begin(), image.values.end()), 0.f);
  }
}

TEST_P(EveryPipeline, DrawsTheSameWithDepthsFirst) {
  const KnownScene known = tests::smokeAndGlass();
  Quality quality = coarse();
  const image::Image image = draw(GetParam(), known, quality);
  quality.depthsFirst = true;
  EXPECT_EQ(draw(GetParam(), known, quality).values, image.values);
}

TEST_P(EveryPipeline, IsTheSameBitsEveryTime) {
  const KnownScene known = tests::smokeAndGlass();
  EXPECT_EQ(draw(GetParam(), known, coarse()).values, draw(GetParam(), known, coarse()).values);
}

INSTANTIATE_TEST_SUITE_P(Pipelines, EveryPipeline, testing::ValuesIn(pipelineNames()),
                         [](const auto& info) { return tests::testName(info.param); });

// One pane and smoke, before or behind it.
TEST_F(PipelinesGpu, OneLayerInFullIsTheListsPicture) {
  Quality quality = coarse();
  quality.deferred.interlace = Interlace::Full;
  for (const KnownScene& known : {tests::paneBeforeSmoke(), tests::smokeBeforePane()}) {
    const image::Image lists = draw("lund", known, quality);
    EXPECT_LT(image::compare(draw("interlaced", known, quality), lists).relativeRmse, rounding) << known.name;
    quality.deferred.layers = 1;
    EXPECT_LT(image::compare(draw("peeling", known, quality), lists).relativeRmse, rounding) << known.name;
  }
}

TEST_F(PipelinesGpu, OneLayerOfSeveralIsNotEnough) {
  Quality quality = coarse();
  const image::Image lists = draw("lund", tests::veilsOverWall(), quality);
  quality.deferred.layers = 1;
  EXPECT_GT(image::compare(draw("peeling", tests::veilsOverWall(), quality), lists).relativeRmse,
            1000 * rounding);
  quality.deferred.layers = 2;
  EXPECT_LT(image::compare(draw("peeling", tests::veilsOverWall(), quality), lists).relativeRmse, rounding);
}

// Away from edges, what stands beside a pixel is what stands in it.
TEST_F(PipelinesGpu, InterlacingLosesNothingOfWhatIsSmooth) {
  KnownScene known;
  tests::add(known.scene, tests::quad({-4, -4, -1}, {8, 0, 0}, {0, 8, 0}), tests::glowing({0.5f, 0.25f, 1}));
  tests::add(known.scene, tests::quad({-4, -4, 0}, {8, 0, 0}, {0, 8, 0}), tests::pane({0.5f, 1, 0.25f}));
  known.scene.cameras = {tests::orthographicCamera({0, 0, 4}, {0, 0, 0}, 1)};
  Quality quality = coarse();
  for (const Interlace interlace : {Interlace::Lines, Interlace::Checkerboard}) {
    quality.deferred.interlace = interlace;
    const image::Image image = draw("interlaced", known, quality);
    for (size_t i = 0; i < image.values.size(); ++i)
      ASSERT_NEAR(image.values[i], 0.25f, 1e-3f) << interlaces().nameOf(interlace) << i;
  }
}

TEST_F(PipelinesGpu, TablesOfEightBitsAreWithinTheirRounding) {
  // A white wall before a light of irradiance 2: a radiance of 2/3, and what is mirrored is nothing.
  KnownScene known;
  tests::add(known.scene, tests::quad({-4, -4, -1}, {8, 0, 0}, {0, 8, 0}), tests::lambert({0.64f, 0.25f, 1}));
  known.scene.lights = {tests::directionalLight({0, 0, -1}, {2, 1, 0.5})};
  known.scene.cameras = {tests::orthographicCamera({0, 0, 4}, {0, 0, 0}, 1)};
  Quality quality = coarse();
  quality.deferred.storage = Storage::Table;
  for (const char* name : {"interlaced", "peeling"}) {
    const image::Image image = draw(name, known, quality);
    const glm::vec3 exact = glm::vec3(0.64f, 0.25f, 1) * glm::vec3(2, 1, 0.5) / 3.14159265f;
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(image.pixel(width / 2, height / 2)[c], exact[c], 1.5 / 255) << name << c;
  }
}

// A wall, red to the left of the middle of the image and blue to the right, behind a pane whose normal leans.
constexpr double lean = 0.25;  // its normal's x
constexpr int shift = 18;      // pixels: lean times the refraction times the height

KnownScene wallBehindPane(double from, double to) {
  KnownScene known;
  tests::add(known.scene, tests::quad({-4, -4, -2}, {4, 0, 0}, {0, 8, 0}), tests::glowing({1, 0, 0}));
  tests::add(known.scene, tests::quad({0, -4, -2}, {4, 0, 0}, {0, 8, 0}), tests::glowing({0, 0, 1}));
  const double slope = lean / std::sqrt(1 - lean * lean);
  tests::add(known.scene,
             tests::quad({from, -4, -slope * from}, {to - from, 0, -slope * (to - from)}, {0, 8, 0}),
             tests::pane({1, 1, 1}));
  known.scene.cameras = {tests::orthographicCamera({0, 0, 4}, {0, 0, 0}, 1)};
  return known;
}

Quality refracting() {
  Quality quality = coarse();
  quality.deferred.refraction = shift / (lean * height);
  return quality;
}

bool isRed(const image::Image& image, int x) {
  return image.pixel(x, height / 2)[0] > 0.5f;
}

TEST_F(PipelinesGpu, RefractionShiftsWhatIsBehind) {
  const KnownScene known = wallBehindPane(-3, 3);
  for (const char* name : {"interlaced", "peeling", "forward", "forward-mask"}) {
    const image::Image straight = draw(name, known, coarse());
    const image::Image bent = draw(name, known, refracting());
    for (int x = 0; x < width - shift; ++x) {
      EXPECT_EQ(isRed(straight, x), x < width / 2) << name << " " << x;
      EXPECT_EQ(isRed(bent, x), x < width / 2 - shift) << name << " " << x;
    }
  }
}

// Aladagli 2015, fig. 4.7: what is behind the pane, but beside it in the image, is not seen through a mask.
TEST_F(PipelinesGpu, AMaskMissesWhatIsBesideASurface) {
  const KnownScene known = wallBehindPane(-3, 0);
  const image::Image depths = draw("forward", known, refracting());
  const image::Image mask = draw("forward-mask", known, refracting());
  for (int x = width / 2 - shift + 1; x < width / 2 - 1; ++x) {
    EXPECT_FALSE(isRed(depths, x)) << x;
    EXPECT_TRUE(isRed(mask, x)) << x;
  }
}

// And what is before the pane, but behind another one, is.
TEST_F(PipelinesGpu, AMaskShowsWhatIsBeforeASurface) {
  KnownScene known = wallBehindPane(-3, 0);
  tests::add(known.scene, tests::quad({0, -4, 2}, {4, 0, 0}, {0, 8, 0}), tests::glowing({0, 1, 0}));
  tests::add(known.scene, tests::quad({0, -4, 3}, {4, 0, 0}, {0, 8, 0}), tests::pane({1, 1, 1}));
  const image::Image depths = draw("forward", known, refracting());
  const image::Image mask = draw("forward-mask", known, refracting());
  for (int x = width / 2 - shift + 1; x < width / 2 - 1; ++x) {
    EXPECT_EQ(depths.pixel(x, height / 2)[1], 0.f) << x;
    EXPECT_GT(mask.pixel(x, height / 2)[1], 0.5f) << x;
  }
}

TEST_F(PipelinesGpu, ForwardHasOneImage) {
  Quality quality = coarse();
  quality.deferred.interlace = Interlace::Full;
  EXPECT_THROW(draw("forward", tests::crossedPanes(), quality), base::Error);
}

}  // namespace
}  // namespace sfumato::pipelines
