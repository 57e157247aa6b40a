// Deep images of frames and of shadow maps: flattened they are the picture, and what is put into them is as
// if it had been drawn there.
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "image/metrics.h"
#include "pipelines/deep_pixels.h"
#include "tests/image/deep_compositing.h"
#include "tests/pipelines/frame_test.h"
#include "tests/pipelines/media_scenes.h"

namespace sfumato::pipelines {
namespace {

using glm::dvec3;
using glm::dvec4;
using image::DeepSample;
using tests::KnownScene;

constexpr int width = 64;
constexpr int height = 48;

class DeepGpu : public FrameTest<width, height> {};

double largest(const image::Image& image) {
  return *std::max_element(image.values.begin(), image.values.end());
}

// Most that a value is off by, of itself and of the brightest.
double worstDifference(const image::Image& a, const image::Image& b, double ofBrightest) {
  const double brightest = largest(b);
  double worst = 0;
  for (size_t i = 0; i < a.values.size(); ++i)
    worst = std::max(worst, std::abs(double(a.values[i]) - b.values[i]) /
                                (std::abs(double(b.values[i])) + ofBrightest * brightest));
  return worst;
}

image::Image flattened(const image::DeepImage& deep) {
  image::Image flat(deep.width, deep.height, 3);
  for (int y = 0; y < deep.height; ++y)
    for (int x = 0; x < deep.width; ++x) {
      const dvec3 colour = test::composite(deep.pixel(x, y)).colour;
      for (int c = 0; c < 3; ++c) flat.pixel(x, y)[c] = static_cast<float>(colour[c]);
    }
  return flat;
}

void expectSorted(const std::vector<DeepSample>& samples) {
  for (size_t i = 0; i < samples.size(); ++i) {
    EXPECT_LE(samples[i].z, samples[i].zBack);
    if (i > 0) {
      EXPECT_LE(samples[i - 1].zBack, samples[i].z);
    }
    EXPECT_GE(samples[i].alpha, 0);
    EXPECT_LE(samples[i].alpha, 1);
  }
}

TEST_F(DeepGpu, FlattenedItIsThePictureAndChangesNone) {
  size_t coloured = 0;
  for (const KnownScene& known :
       {tests::shinySpheres(), tests::smokeAndGlass(), tests::colouredBalls(), tests::fireBehindSmoke()}) {
    SCOPED_TRACE(known.name);
    const Frame frame = draw(known, smooth(1), {.deep = true});
    ASSERT_TRUE(frame.deep);
    EXPECT_LT(worstDifference(flattened(*frame.deep), frame.radiance, 1e-3), 1e-4);
    for (const auto& samples : frame.deep->pixels) {
      expectSorted(samples);
      for (const DeepSample& sample : samples)
        if (sample.takes[0] != sample.takes[2]) ++coloured;
    }
    const Frame without = draw(known, smooth(1), {});
    EXPECT_FALSE(without.deep);
    EXPECT_LT(worstDifference(frame.radiance, without.radiance, 1e-3), 1e-5);
  }
  EXPECT_GT(coloured, 1000u);  // panes
}

TEST_F(DeepGpu, WhatFindsNoRoomIsNotLost) {
  const KnownScene known = tests::smokeOverFloor();
  LinkedListsPipeline pipeline(device(), known.scene, known.media);
  const auto render = [&](int w, int h, const FrameOptions& options) {
    return pipeline.render(known.scene.cameras[0], w, h, smooth(1), options);
  };
  const Frame whole = render(width, height, {.deep = true});
  const Frame crowded = render(width, height, {.deep = true, .deepLimits = {.eventBytes = 1 << 12}});
  EXPECT_GT(crowded.statistics.resolveDispatches, 10 * whole.statistics.resolveDispatches);
  EXPECT_TRUE(crowded.deep->pixels == whole.deep->pixels);
  const Frame windows = render(width, height, {.deep = true, .windowPixels = 1000});
  EXPECT_TRUE(windows.deep->pixels == whole.deep->pixels);
  // A pixel that fills the room alone gets more.
  EXPECT_TRUE(render(3, 2, {.deep = true, .deepLimits = {.eventBytes = 64}}).deep->pixels ==
              render(3, 2, {.deep = true}).deep->pixels);
  try {
    render(width, height, {.deep = true, .deepLimits = {.sampleBytes = 1 << 16}});
    FAIL() << "no error";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.exitCode, base::ExitCode::Memory);
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("lower the resolution"), std::string::npos) << error.what();
  }
}

// A card that glows, or a pane, across smoke. The sun is in its plane, so that neither shadows the other.
constexpr double cardDepth = 4.6;  // the ball's are 3.9 to 6.1

KnownScene sunnyBall() {
  KnownScene known{"sunny ball", {}, {}};
  tests::add(known.scene, tests::quad({-6, -3, -2}, {12, 0, 0}, {0, 6, 0}),
             tests::glowing({0.3f, 0.2f, 0.1f}));
  known.media.push_back(tests::ball({0, 0, 0}, 1.1, 48, 5, {0.9, 0.8, 0.7}, 0.3));
  known.scene.lights.push_back(tests::directionalLight({0, -1, 0}, {3, 4, 5}));
  known.scene.cameras.push_back(tests::perspectiveCamera({0, 0, 5}, {0, 0, 0}, 0.5));
  return known;
}

void addCard(KnownScene& known, const scene::Material& material) {
  const auto z = static_cast<float>(5 - cardDepth);
  tests::add(known.scene, tests::quad({-0.7f, -0.6f, z}, {1.4f, 0.1f, 0}, {-0.1f, 1.2f, 0}), material);
}

// The card's samples among those of the other image.
image::Image withCard(const image::DeepImage& deep, const image::DeepImage& card) {
  image::Image result(deep.width, deep.height, 3);
  for (int y = 0; y < deep.height; ++y)
    for (int x = 0; x < deep.width; ++x) {
      const test::Composite before = test::compositeUpTo(deep.pixel(x, y), cardDepth);
      const test::Composite whole = test::composite(deep.pixel(x, y));
      const test::Composite own = test::composite(card.pixel(x, y));
      for (int c = 0; c < 3; ++c)
        result.pixel(x, y)[c] =
            static_cast<float>(before.colour[c] + before.passedOfEach[c] * own.colour[c] +
                               own.passedOfEach[c] * (whole.colour[c] - before.colour[c]));
    }
  return result;
}

// In the middle of the smoke, within the bound of compositing there: 1/512 of the card and of the pixel.
// Where the card's edge crosses a pixel, its rays pass smoke of their own, which the mean of the pixel's is
// not.
TEST_F(DeepGpu, ACardPutIntoTheSmokeIsAsIfDrawnThere) {
  const Frame smoke = draw(sunnyBall(), smooth(1), {.deep = true});
  for (const scene::Material& material : {tests::glowing({1, 1.5f, 0.5f}), tests::pane({0.8f, 0.5f, 0.2f})}) {
    KnownScene all = sunnyBall();
    addCard(all, material);
    KnownScene cardAlone{"card", all.scene, {}};
    cardAlone.scene.instances.erase(cardAlone.scene.instances.begin());
    const Frame card = draw(cardAlone, smooth(1), {.deep = true});
    const Frame drawn = draw(all, smooth(1), {});
    const image::Image put = withCard(*smoke.deep, *card.deep);
    keep("deep_card_put", put);
    keep("deep_card_drawn", drawn.radiance);
    double inside = 0;
    double atEdges = 0;
    size_t covered = 0;
    const double full = test::composite(card.deep->pixel(width / 2, height / 2)).passed;
    for (size_t i = 0; i < put.values.size(); ++i) {
      const double passed = test::composite(card.deep->pixels[i / 3]).passed;
      const bool whole = std::abs(passed - full) < 1e-3;
      const bool edge = !whole && passed < 0.999;
      double& worst = edge ? atEdges : inside;
      worst = std::max(worst, std::abs(double(put.values[i]) - drawn.radiance.values[i]));
      if (whole) ++covered;
    }
    fmt::print("card: off by {:.5f}, at its edges by {:.5f}\n", inside, atEdges);
    EXPECT_LT(inside, deepError * (1.5 + largest(smoke.radiance)));
    EXPECT_LT(atEdges, 0.02);
    EXPECT_GT(covered, put.values.size() / 8);
    EXPECT_GT(worstDifference(smoke.radiance, drawn.radiance, 0.1), 0.2);  // the card matters
    // Were it put before the smoke, that would be seen.
    image::DeepImage moved = *smoke.deep;
    for (auto& samples : moved.pixels)
      for (DeepSample& sample : samples) {
        sample.z += 2;
        sample.zBack += 2;
      }
    EXPECT_GT(worstDifference(withCard(moved, *card.deep), drawn.radiance, 0.1), 0.05);
  }
}

// Where a world point is in an image, in pixels, and its depth there.
dvec3 placeIn(const image::DeepImage& image, const dvec3& p) {
  const auto times = [&](const image::Matrix& matrix) {
    dvec4 result(0);
    const dvec4 point(p, 1);
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 4; ++column)
        result[column] += point[row] * matrix[static_cast<size_t>(4 * row + column)];
    return result;
  };
  const dvec4 ndc = times(image.view.worldToNdc);
  return {ndc.x / ndc.w * image.width, ndc.y / ndc.w * image.height, times(image.view.worldToCamera).z};
}

void expectSurfaceAt(const image::DeepImage& image, const dvec3& p) {
  const dvec3 place = placeIn(image, p);
  ASSERT_TRUE(place.x >= 0 && place.x < image.width && place.y >= 0 && place.y < image.height);
  const auto& samples = image.pixel(static_cast<int>(place.x), static_cast<int>(place.y));
  const bool found = std::ranges::any_of(samples, [&](const DeepSample& sample) {
    return sample.z == sample.zBack && std::abs(sample.z - place.z) < 2e-2 * place.z;
  });
  EXPECT_TRUE(found) << place.x << " " << place.y << " " << place.z;
}

TEST_F(DeepGpu, TheMatricesSayWhereThingsAre) {
  const KnownScene known = tests::smokeAndGlass();
  const Frame frame = draw(known, smooth(1), {.deep = true, .deepShadows = {0, 1, 2}});
  expectSurfaceAt(*frame.deep, {-1.4, 0.4, 0.5});  // the front of a box
  expectSurfaceAt(*frame.deep, {1.4, 0.6, -0.5});
  ASSERT_EQ(frame.deepShadows.size(), 3u);
  ASSERT_EQ(frame.deepShadows[0].size(), 1u);
  expectSurfaceAt(frame.deepShadows[0][0], {-1.4, 0.8, 0});  // its top, seen by the spot
  ASSERT_EQ(frame.deepShadows[1].size(), 6u);
  EXPECT_EQ(frame.deepShadows[1][0].name, "+x");
  EXPECT_EQ(frame.deepShadows[1][5].name, "-z");
  expectSurfaceAt(frame.deepShadows[1][3], {2.3, 0, 1.3});     // the floor below the lamp: -y
  expectSurfaceAt(frame.deepShadows[1][5], {1.4, 0.6, -0.5});  // a box: -z
  ASSERT_EQ(frame.deepShadows[2].size(), 1u);
  EXPECT_EQ(frame.deepShadows[2][0].name, "");
  expectSurfaceAt(frame.deepShadows[2][0], {-1.4, 0.8, 0});
}

TEST_F(DeepGpu, AShadowMapsSamplesTakeWhatTheLightLoses) {
  KnownScene known = tests::smokeOverFloor();  // sigma 0.8 over a metre, slanting by 4/5
  tests::add(known.scene, tests::quad({-4, 1, 4}, {8, 0, 0}, {0, 0, -8}), tests::pane({0.75f, 0.5f, 0.25f}));
  const Frame frame = draw(known, smooth(1), {.deepShadows = {0}});
  EXPECT_FALSE(frame.deep);
  const image::DeepImage& map = frame.deepShadows.at(0).at(0);
  const dvec3 place = placeIn(map, {0, 0, 0});
  const auto& samples = map.pixel(static_cast<int>(place.x), static_cast<int>(place.y));
  const double smoke = std::exp(-0.8 / 0.8);
  const test::Composite beforePane = test::compositeUpTo(samples, place.z - 1.5);
  const test::Composite beforeFloor = test::compositeUpTo(samples, place.z - 0.5);
  const dvec3 pane(0.75, 0.5, 0.25);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(beforePane.passedOfEach[c], smoke, 2.0 / 512) << c;
    EXPECT_NEAR(beforeFloor.passedOfEach[c], smoke * pane[c], 3.0 / 512) << c;
  }
  EXPECT_EQ(samples.back().alpha, 1);
  EXPECT_NEAR(samples.back().z, place.z, 0.05);
  EXPECT_EQ(test::composite(samples).passed, 0);
}

}  // namespace
}  // namespace sfumato::pipelines
