// The re-entrant pipeline: the core pipeline's picture where its passes hold all surfaces that there are, and
// what it is known to lose.
#include "pipelines/reentrant_gpu.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "image/metrics.h"
#include "pipelines/pipeline_gpu.h"
#include "tests/pipelines/known_scenes.h"
#include "tests/pipelines/pipeline_test.h"

namespace sfumato::pipelines {
namespace {

using tests::KnownScene;

Quality coarseIn(Passes passes) {
  Quality quality = coarse();
  quality.deferred.passes = passes;
  return quality;
}

class ReentrantGpu : public PipelineTest {};

class KnownScenesReentrant : public ReentrantGpu, public testing::WithParamInterface<std::string> {};

TEST_P(KnownScenesReentrant, ObjectByObjectAreTheListsPicture) {
  expectListsPicture("reentrant", tests::named(tests::knownScenes(), GetParam()), coarse());
}

INSTANTIATE_TEST_SUITE_P(KnownScenes, KnownScenesReentrant,
                         testing::ValuesIn(tests::namesOf(tests::knownScenes())),
                         [](const auto& info) { return tests::testName(info.param); });

// Before a wall that glows in two colours, left and right of x = 0.
KnownScene twoColouredWall() {
  KnownScene known{.name = "two_coloured_wall"};
  known.scene.cameras.push_back(tests::orthographicCamera({0, 0, 4}, {0, 0, 0}, 1));
  tests::add(known.scene, tests::quad({-4, -4, -2}, {4, 0, 0}, {0, 8, 0}), tests::glowing({1, 2, 4}));
  tests::add(known.scene, tests::quad({0, -4, -2}, {4, 0, 0}, {0, 8, 0}), tests::glowing({4, 2, 1}));
  return known;
}

void expectColour(const image::Image& image, int x, int y, const glm::vec3& expected) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(image.pixel(x, y)[c], expected[c], 4e-3f * expected[c]);
}

TEST_F(ReentrantGpu, OnePassShowsTheNearestSurface) {
  KnownScene known = twoColouredWall();
  tests::add(known.scene, tests::quad({-4, -4, 0}, {8, 0, 0}, {0, 8, 0}), tests::pane({0.5f, 0.25f, 0.75f}));
  tests::add(known.scene, tests::quad({-4, -4, 1}, {8, 0, 0}, {0, 8, 0}), tests::pane({0.75f, 0.5f, 0.25f}));
  const image::Image nearest = draw("reentrant", known, coarseIn(Passes::One), {48, 36});
  expectColour(nearest, 5, 5, glm::vec3(1, 2, 4) * glm::vec3(0.75f, 0.5f, 0.25f));
  const image::Image both = draw("reentrant", known, coarse(), {48, 36});
  expectColour(both, 5, 5,
               glm::vec3(1, 2, 4) * glm::vec3(0.75f, 0.5f, 0.25f) * glm::vec3(0.5f, 0.25f, 0.75f));
}

TEST_F(ReentrantGpu, OnePassIsEnoughForOnePane) {
  expectListsPicture("reentrant", tests::paneBeforeSmoke(), coarseIn(Passes::One));
  expectListsPicture("reentrant", tests::smokeBeforePane(), coarseIn(Passes::One));
}

// A pane before the left half of a glowing wall, as one layer after the wall.
struct PaneOverWall {
  explicit PaneOverWall(gl::Device& device)
      : known(twoColouredWall()),
        paneNumber(static_cast<size_t>(tests::add(known.scene, tests::quad({-4, -4, 0}, {4, 0, 0}, {0, 8, 0}),
                                                  tests::pane({0.5f, 0.5f, 0.5f})))),
        scene(device, known.scene, known.media),
        frame(scene, known.scene.cameras[0], 48, 36, coarse()),
        finished(noLight(frame)),
        layer(frame.layer("layer")) {
    frame.draw(layer, {.mask = {drawn}});
    shadeOver(frame, layer, nullptr, {whereDrawn}, finished);
    frame.draw(layer,
               {.surfaces = LayerDraw::Surfaces::Translucent, .before = &finished.seen, .mask = {drawn}});
  }

  KnownScene known;
  size_t paneNumber;
  SceneGpu scene;
  LayeredFrame frame;
  FinishedLight finished;
  SurfaceLayer layer;
};

// Of a pixel; rows count from the bottom.
float redOf(const gl::Texture& image, int x, int y) {
  std::vector<glm::vec4> texels(static_cast<size_t>(image.size().x) * static_cast<size_t>(image.size().y));
  image.read(std::as_writable_bytes(std::span(texels)));
  return texels[static_cast<size_t>(y) * static_cast<size_t>(image.size().x) + static_cast<size_t>(x)].r;
}

TEST_F(ReentrantGpu, TheMaskKeepsWhatALayerDoesNotCover) {
  PaneOverWall masked(device());
  shadeOver(masked.frame, masked.layer, nullptr, {whereDrawn}, masked.finished);
  EXPECT_EQ(redOf(masked.finished.radiance, 5, 5), 0);   // cleared, and no background added
  EXPECT_EQ(redOf(masked.finished.radiance, 40, 5), 4);  // the wall

  PaneOverWall open(device());
  shadeOver(open.frame, open.layer, nullptr, {}, open.finished);
  EXPECT_EQ(redOf(open.finished.radiance, 40, 5), 0);  // lost without the mask
}

// Small balls of coloured glass and veils here and there, before and across each other and the border of the
// image, one around the camera; some in smoke.
KnownScene smallObjects() {
  KnownScene known{.name = "small_objects"};
  tests::add(known.scene, tests::quad({-4, -1, 4}, {8, 0, 0}, {0, 0, -8}),
             tests::lambert({0.8f, 0.6f, 0.4f}));
  const auto ball = [&](const glm::dvec3& centre, double radius, const scene::Material& material) {
    glm::dmat4 worldFromBall = glm::dmat4(glm::dmat3(radius));
    worldFromBall[3] = glm::dvec4(centre, 1);
    tests::add(known.scene, tests::sphere(12, 24), material, worldFromBall);
  };
  ball({-1.2, 0.3, 0}, 0.3, tests::pane({0.9f, 0.5f, 0.3f}));
  ball({-0.9, 0.2, 0.6}, 0.2, tests::veil({0.2f, 0.7f, 0.9f}, 0.5f));
  ball({0.4, -0.5, 0.5}, 0.25, tests::pane({0.4f, 0.9f, 0.5f}));
  ball({1.9, 0.9, -0.5}, 0.4, tests::veil({0.9f, 0.4f, 0.7f}, 0.6f));
  ball({0.2, 0.9, -1}, 0.15, tests::pane({0.5f, 0.5f, 0.9f}));
  ball({0, 0, 4}, 0.5, tests::veil({0.6f, 0.6f, 0.6f}, 0.1f));
  known.scene.lights = {tests::pointLight({0, 1.5, 1}, {3, 3, 3}),
                        tests::directionalLight({0.3, -1, -0.2}, {1, 1, 1})};
  known.media = {tests::ball({-1, 0.2, 0.2}, 0.6, 16, 1.5, glm::dvec3(0.7), 0.2)};
  return known;
}

class ReentrantAreasGpu : public ReentrantGpu {
 protected:
  // What is finished when all passes were drawn, each within the area that `change` made of its own.
  std::vector<glm::vec4> finishedWith(const KnownScene& known, const glm::ivec2& size,
                                      const std::function<void(std::optional<glm::ivec4>&)>& change) {
    const SceneGpu scene(device(), known.scene, known.media);
    Quality quality = coarse();
    quality.deferred.refraction = 0.05;
    LayeredFrame frame(scene, known.scene.cameras[0], size.x, size.y, quality);
    const FinishedLight finished = noLight(frame);
    const SurfaceLayer layer = frame.layer("layer");
    frame.draw(layer, {.mask = {drawn}});
    shadeOver(frame, layer, nullptr, {whereDrawn}, finished);
    Walk walk = frame.startWalk();
    for (LayerDraw& pass : translucentPasses(frame, finished)) {
      change(pass.mask.area);
      drawOver(frame, pass, layer, finished, walk);
    }
    const auto pixels = static_cast<size_t>(size.x) * static_cast<size_t>(size.y);
    std::vector<glm::vec4> result(pixels);
    finished.radiance.read(std::as_writable_bytes(std::span(result)));
    std::vector<float> depths(pixels);
    finished.seen.depth.read(std::as_writable_bytes(std::span(depths)));
    for (size_t i = 0; i < pixels; ++i) result[i].w = depths[i];
    return result;
  }
};

TEST_F(ReentrantAreasGpu, ArePartsOfTheImageThatLoseNothing) {
  KnownScene known = smallObjects();
  const glm::ivec2 sizes[] = {{72, 54}, {37, 61}, {4097, 3}, {1, 1}};
  for (const bool orthographic : {false, true}) {
    const glm::dvec3 eye(0, 0.4, 4.1);
    known.scene.cameras = {orthographic ? tests::orthographicCamera(eye, {0, 0, 0}, 1.2)
                                        : tests::perspectiveCamera(eye, {0, 0, 0}, 0.6)};
    for (const glm::ivec2& size : sizes) {
      SCOPED_TRACE(fmt::format("{}x{}, orthographic {}", size.x, size.y, orthographic));
      double share = 0;  // of the image, summed over the passes
      int passes = 0;
      const auto own = finishedWith(known, size, [&](std::optional<glm::ivec4>& area) {
        ASSERT_TRUE(area);
        ++passes;
        share += area->z * area->w / double(size.x * size.y);
      });
      EXPECT_EQ(own, finishedWith(known, size, [](auto& area) { area.reset(); }));
      if (size != sizes[0]) continue;
      EXPECT_EQ(passes, 12);           // both sides of six balls
      EXPECT_LT(share, 2 + 10 * 0.1);  // the camera is in one of them
      // Each side has a margin of a pixel and what is rounded: some lines less, and something is missing.
      for (const glm::ivec4& cut : {glm::ivec4(4, 0, -4, 0), glm::ivec4(0, 4, 0, -4), glm::ivec4(0, 0, -4, 0),
                                    glm::ivec4(0, 0, 0, -4)})
        EXPECT_NE(own, finishedWith(known, size, [&](auto& area) { area = *area + cut; }));
    }
  }
}

// A pane whose normal leans by `slope` towards +x, as a quad across the image.
scene::Mesh leaningPane(float slope) {
  return tests::quad({-2, -4, 2 * slope}, {4, 0, -4 * slope}, {0, 8, 0});
}

TEST_F(ReentrantGpu, RefractionShiftsWhatIsSeen) {
  constexpr int width = 64;
  constexpr int height = 48;
  constexpr float slope = 0.25f;
  KnownScene known = twoColouredWall();
  tests::add(known.scene, leaningPane(slope), tests::pane({0.5f, 0.5f, 0.5f}));
  Quality quality = coarse();
  const image::Image straight = draw("reentrant", known, quality, {width, height});
  quality.deferred.refraction = 0.5;
  const image::Image bent = draw("reentrant", known, quality, {width, height});
  const int shift = static_cast<int>(std::lround(slope / std::hypot(1.f, slope) * 0.5f * height));
  ASSERT_GT(shift, 3);
  // The edge of the two colours stands at the middle; seen through the pane it is further left.
  for (int x = 0; x < width; ++x) {
    const float red = x < width / 2 ? 0.5f : 2.f;
    const float shifted = x + shift < width / 2 ? 0.5f : 2.f;
    EXPECT_NEAR(straight.pixel(x, 20)[0], red, 4e-3f);
    EXPECT_NEAR(bent.pixel(x, 20)[0], shifted, 4e-3f);
  }
}

TEST_F(ReentrantGpu, WhatStandsBeforeAPaneIsNotSmearedIntoIt) {
  KnownScene known = twoColouredWall();
  tests::add(known.scene, leaningPane(0.25f), tests::pane({0.5f, 0.5f, 0.5f}));
  // A post before the pane, at the right.
  tests::add(known.scene, tests::quad({0.5f, -4, 2}, {0.2f, 0, 0}, {0, 8, 0}),
             tests::glowing({100, 100, 100}));
  Quality quality = coarse();
  quality.deferred.refraction = 0.5;
  const image::Image image = draw("reentrant", known, quality, {64, 48});
  for (int x = 0; x < 64; ++x) {
    const float red = image.pixel(x, 20)[0];
    EXPECT_TRUE(red == 100 || red <= 2.01f) << x << ": " << red;
  }
}

TEST_F(ReentrantGpu, ImagesOfAnySize) {
  for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(37, 23), glm::ivec2(4097, 3)}) {
    SCOPED_TRACE(size.x);
    expectListsPicture("reentrant", tests::crossedPanes(), coarse(), size);
  }
}

TEST_F(ReentrantGpu, TableStorageIsCloseAndSmaller) {
  const KnownScene known = tests::veilsOverWall();
  const image::Image exact = draw("reentrant", known, coarse());
  Quality quality = coarse();
  quality.deferred.storage = Storage::Table;
  const double error = image::compare(draw("reentrant", known, quality), exact).relativeRmse;
  EXPECT_LT(error, 0.05);  // of colours in 8 bits
  EXPECT_GT(error, 0);
}

}  // namespace
}  // namespace sfumato::pipelines
