// Lights cost list nodes only where they touch something that is seen, and the picture is what it was.
#include <gtest/gtest.h>

#include "base/random.h"
#include "tests/pipelines/frame_test.h"

namespace sfumato::pipelines {
namespace {

using tests::KnownScene;

constexpr int width = 96;
constexpr int height = 72;

// The camera looks along -Z from z = 4 at a wall at z = 0.
KnownScene wallBeforeCamera() {
  KnownScene known{.name = "wall"};
  known.scene.cameras = {tests::perspectiveCamera({0, 0, 4}, {0, 0, 0}, 0.8)};
  tests::add(known.scene, tests::quad({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}),
             tests::lambert({0.7f, 0.6f, 0.5f}));
  return known;
}

scene::Light smallLight(const glm::dvec3& position, double range) {
  scene::Light light = tests::pointLight(position, {1, 2, 3});
  light.range = range;
  light.castsShadow = false;
  return light;
}

class ReceiversGpuFrames : public FrameTest<width, height> {};

class ReceiversGpu : public ReceiversGpuFrames, public testing::WithParamInterface<int> {
 protected:
  Frame draw(const KnownScene& known, const FrameOptions& options = {}) {
    Quality quality = fine;
    quality.samples = GetParam();
    return ReceiversGpuFrames::draw(known, quality, options);
  }
  // List nodes of one light at a depth of the world.
  size_t nodes(KnownScene known, double z) {
    known.scene.lights = {smallLight({0, 0, z}, 0.4)};
    return draw(known).statistics.lights.stored;
  }
};

TEST_P(ReceiversGpu, LightsThatTouchNothingSeenCostNothing) {
  const KnownScene wall = wallBeforeCamera();
  EXPECT_EQ(nodes(wall, 2), 0u) << "in the air before the wall";
  EXPECT_EQ(nodes(wall, -0.6), 0u) << "behind the wall";
  EXPECT_GT(nodes(wall, 0.3), 0u) << "before the wall, near enough";
  EXPECT_GT(nodes(wall, -0.3), 0u) << "its range reaches through the wall: it lights the wall from behind";
}

TEST_P(ReceiversGpu, SmokeAndGlassAreSeen) {
  KnownScene smoky = wallBeforeCamera();
  smoky.media.push_back(tests::block({-0.5, -0.5, 1.5}, {0.5, 0.5, 2.5}, {8, 8, 8}, 0.5, {0.9, 0.9, 0.9}, 0));
  EXPECT_GT(nodes(smoky, 2), 0u);
  EXPECT_EQ(nodes(smoky, 3.2), 0u) << "before the smoke";
  EXPECT_EQ(nodes(smoky, -0.6), 0u);

  KnownScene glazed = wallBeforeCamera();
  tests::add(glazed.scene, tests::quad({-1, -1, 2}, {2, 0, 0}, {0, 2, 0}), tests::veil({1, 1, 1}, 0.5f));
  EXPECT_GT(nodes(glazed, 2), 0u);
  EXPECT_EQ(nodes(glazed, 3), 0u);

  KnownScene open = smoky;  // nothing behind the smoke
  open.scene.instances.clear();
  EXPECT_GT(nodes(open, 2), 0u);
  EXPECT_EQ(nodes(open, 0.9), 0u) << "behind the smoke";
}

// Surfaces of a few pixels, off the cells' middles, with a lamp over each that reaches little else.
KnownScene smallThings() {
  KnownScene known{.name = "small things"};
  known.scene.cameras = {tests::perspectiveCamera({0, 0, 4}, {0, 0, 0}, 0.8)};
  base::Random random(3);
  for (int i = 0; i < 40; ++i) {
    const glm::vec3 p(random.uniform(-1.7, 1.7), random.uniform(-1.3, 1.3), random.uniform(-1, 1));
    tests::add(known.scene, tests::quad(p, {0.09f, 0.02f, 0.03f}, {-0.02f, 0.09f, 0.05f}),
               i % 2 == 0 ? tests::lambert({1, 1, 1}) : tests::veil({1, 1, 1}, 0.5f));
    known.scene.lights.push_back(smallLight(glm::dvec3(p) + glm::dvec3(0.03, 0.03, 0.15), 0.25));
  }
  return known;
}

TEST_P(ReceiversGpu, LightsAreFoundBesideTheMiddleOfACell) {
  const KnownScene known = smallThings();
  const Frame frame = draw(known);
  // Where next to nothing is everywhere before the surfaces, no light before them is left out.
  KnownScene filled = known;
  filled.media.push_back(tests::block({-9, -9, -9}, {9, 9, 9}, {2, 2, 2}, 1e-7, {0, 0, 0}, 0));
  const Frame uncut = draw(filled);
  EXPECT_LT(frame.statistics.lights.stored, uncut.statistics.lights.stored);
  for (size_t i = 0; i < frame.radiance.values.size(); ++i)
    EXPECT_NEAR(frame.radiance.values[i], uncut.radiance.values[i], 1e-5 * (1 + uncut.radiance.values[i]))
        << i;
}

TEST_F(ReceiversGpuFrames, SmallSmokeIsFoundBesideTheMiddleOfACell) {
  KnownScene known = smallThings();
  known.media.push_back(tests::block({0.31, 0.32, 0.2}, {0.39, 0.41, 0.3}, {4, 4, 4}, 4, {0.9, 0.9, 0.9}, 0));
  known.scene.lights.push_back(smallLight({0.35, 0.36, 0.25}, 0.05));
  const Frame frame = draw(known, fine);
  const image::Image reference = referenceOf(known);
  const PixelErrors found = compareFrames(known.name, frame.radiance, reference);
  EXPECT_NEAR(found.meanRatio, 1.0, 0.01);
  EXPECT_LT(found.failingFraction, 0.005);
}

// A wall asks each of the lights that may reach it once a pixel, and the shadow of those that do.
TEST_P(ReceiversGpu, LookupsAreCounted) {
  KnownScene known = wallBeforeCamera();
  for (int i = 0; i < 3; ++i) {
    known.scene.lights.push_back(tests::directionalLight({0.1 * i, 0, -1}, {1, 1, 1}));
    known.scene.lights.push_back(smallLight({0, 0, 1}, 50));
    known.scene.lights.back().castsShadow = i == 0;
  }
  const Lookups lookups = draw(known, {.countLookups = true}).statistics.lookups;
  EXPECT_EQ(lookups.pixels, static_cast<size_t>(width * height));
  EXPECT_EQ(lookups.lights, 6 * lookups.pixels);
  EXPECT_EQ(lookups.mostLights, 6u);
  EXPECT_EQ(lookups.shadows, 4 * lookups.pixels);
  EXPECT_EQ(lookups.mostShadows, 4u);
  EXPECT_EQ(draw(known).statistics.lookups.pixels, 0u) << "unasked for";
  EXPECT_EQ(draw(known, {.countLookups = true}).radiance.values, draw(known).radiance.values);
}

INSTANTIATE_TEST_SUITE_P(, ReceiversGpu, testing::Values(1, 4),
                         [](const auto& info) { return info.param == 1 ? "OneSample" : "FourSamples"; });

// Many moving lights, shadowed and not, against the reference.
TEST_F(ReceiversGpuFrames, ManyLightsLightWhatTheReferenceLights) {
  Quality quality = fine;
  quality.shadowResolution = 256;
  for (const double seconds : {0.0, 0.7}) {
    KnownScene known = tests::smokeAndGlass();
    known.name = fmt::format("many lights at {} s", seconds);
    known.scene.lights.clear();
    base::Random random(11);
    for (int i = 0; i < 60; ++i) {
      const glm::dvec3 p(random.uniform(-2, 2), random.uniform(0, 2), random.uniform(-2, 2));
      const glm::dvec3 velocity(random.uniform(-1, 1), random.uniform(-0.3, 0.3), random.uniform(-1, 1));
      scene::Light light =
          i % 2 == 0 ? tests::pointLight(p, glm::dvec3(0.05))
                     : tests::spotLight(p, {0, 0.5, 0}, glm::dvec3(0.2), 0.1, random.uniform(0.2, 1.2));
      light.position = p + seconds * velocity;
      light.range = random.uniform(0.3, 1.5);
      light.castsShadow = i % 15 == 0;
      known.scene.lights.push_back(light);
    }
    const Frame frame = draw(known, quality, {.countLookups = true});
    const image::Image reference = referenceOf(known);
    const PixelErrors found = compareFrames(known.name, frame.radiance, reference);
    // Edges of four shadows, and pixels whose ray all but hits a lamp: those make the mean, which tells
    // nothing.
    EXPECT_LT(found.failingFraction, 0.01);
    const Lookups& lookups = frame.statistics.lookups;
    EXPECT_EQ(lookups.pixels, static_cast<size_t>(width * height));
    EXPECT_GT(lookups.lights, lookups.pixels);
    EXPECT_GE(lookups.mostLights * lookups.pixels, lookups.lights);
    EXPECT_GT(lookups.shadows, 0u);
    EXPECT_LT(lookups.shadows, lookups.lights * 4);  // of some of the lights
  }
}

}  // namespace
}  // namespace sfumato::pipelines
