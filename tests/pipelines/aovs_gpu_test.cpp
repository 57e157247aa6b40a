// What the GPU tells of pixels beside their radiance, against known answers and the CPU reference.
#include "pipelines/aovs.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "base/error.h"
#include "image/metrics.h"
#include "pipelines/aovs_gpu.h"
#include "tests/pipelines/frame_test.h"

namespace sfumato::pipelines {
namespace {

using tests::KnownScene;

constexpr int width = 96;
constexpr int height = 72;
const AovSet all = {Aov::Depth,  Aov::Normal,    Aov::Albedo,     Aov::Transmittance,
                    Aov::Lights, Aov::Fragments, Aov::ShadowNodes};

class AovsGpu : public FrameTest<width, height> {};

// Of the pixels: a value of which is off by more than `tolerance`, absolute and relative.
double failingFraction(const image::Image& image, const image::Image& reference, double tolerance) {
  size_t failing = 0;
  for (size_t i = 0; i < image.values.size(); ++i) {
    const double a = image.values[i];
    const double b = reference.values[i];
    if (a != b && !(std::abs(a - b) <= tolerance * (1 + std::abs(b)))) ++failing;  // infinities are equal
  }
  return static_cast<double>(failing) / static_cast<double>(image.values.size());
}

// At edges of surfaces a rasterised pixel and a ray through its centre may see two of them. Measured: fewer
// than 0.00005 of the values. None of these AOVs asks for lights, without which both are faster.
TEST_F(AovsGpu, AreThoseOfTheReference) {
  const AovSet shared = {Aov::Depth, Aov::Normal, Aov::Albedo, Aov::Transmittance, Aov::Fragments};
  const std::map<Aov, double> tolerances = {{Aov::Depth, 1e-4},  // what is packed into halves and octahedra
                                            {Aov::Normal, 1e-3},
                                            {Aov::Albedo, 1e-3},
                                            {Aov::Transmittance, 4e-3},
                                            {Aov::Fragments, 0}};
  for (KnownScene& known : tests::knownScenes()) {
    known.scene.lights.clear();
    const Frame frame = draw(known, fine, {.aovs = shared});
    const ReferenceFrame reference = traceReference(known.scene, known.scene.cameras[0], known.media,
                                                    {.width = width, .height = height, .aovs = shared});
    ASSERT_EQ(frame.aovs.size(), shared.size());
    for (const auto& [aov, image] : reference.aovs) {
      const double failing = failingFraction(frame.aovs.at(aov), image, tolerances.at(aov));
      EXPECT_LT(failing, 0.0005) << known.name << " " << aovKinds().nameOf(aov);
    }
  }
}

// For pipelines that tell none: one sample a pixel.
TEST_F(AovsGpu, SurfacesAloneAreThoseOfTheFrame) {
  for (KnownScene& known : tests::knownScenes()) {
    known.scene.lights.clear();
    known.media.clear();
    Quality quality = fine;
    quality.samples = 1;
    const Frame frame = draw(known, quality, {.aovs = {Aov::Depth, Aov::Normal}});
    const SceneGpu scene(device(), known.scene, known.media);
    AovImages alone = emptyImages({Aov::Depth, Aov::Normal}, width, height);
    drawSurfaceAovs(scene, known.scene.cameras[0], alone);
    EXPECT_EQ(alone.at(Aov::Depth).values, frame.aovs.at(Aov::Depth).values) << known.name;
    EXPECT_EQ(failingFraction(alone.at(Aov::Normal), frame.aovs.at(Aov::Normal), 1e-6), 0) << known.name;
  }
}

TEST_F(AovsGpu, OfAnotherViewWouldNotPass) {
  KnownScene known = tests::smokeAndGlass();
  known.scene.lights.clear();
  const Frame frame = draw(known, fine, {.aovs = all});
  known.scene.cameras[0].worldFromView[3].x += 0.02;
  const Frame moved = draw(known, fine, {.aovs = all});
  for (const Aov aov : {Aov::Depth, Aov::Normal, Aov::Albedo, Aov::Transmittance, Aov::Fragments})
    EXPECT_GT(failingFraction(moved.aovs.at(aov), frame.aovs.at(aov), 4e-3), 0.0005)
        << aovKinds().nameOf(aov);
}

TEST_F(AovsGpu, LeaveThePictureAsItIs) {
  const KnownScene known = tests::smokeAndGlass();
  const Frame plain = draw(known, smooth(), {});
  EXPECT_TRUE(plain.aovs.empty());
  EXPECT_EQ(draw(known, smooth(), {.aovs = all}).radiance.values, plain.radiance.values);
}

TEST_F(AovsGpu, AreTheSameInWindows) {
  const KnownScene known = tests::smokeAndGlass();
  const Frame whole = draw(known, smooth(), {.aovs = all});
  const Frame parts = draw(known, smooth(), {.aovs = all, .windowPixels = 300});
  for (const Aov aov : all)
    EXPECT_EQ(parts.aovs.at(aov).values, whole.aovs.at(aov).values) << aovKinds().nameOf(aov);
}

// A white wall 3 m away, turned by 45 degrees about Y, that covers the right half of what is seen.
KnownScene slantingWall() {
  KnownScene known;
  known.scene.cameras = {tests::orthographicCamera({0, 0, 3}, {0, 0, 0}, 1)};
  tests::add(known.scene, tests::quad({0, -2, 0}, {2, 0, -2}, {0, 4, 0}), tests::lambert({0.25f, 0.5f, 1}));
  return known;
}

TEST_F(AovsGpu, TellThePlaceAndTheDirectionOfASurface) {
  for (const int samples : {1, 4}) {
    Quality quality = fine;
    quality.samples = samples;
    const Frame frame = draw(slantingWall(), quality, {.aovs = all});
    const double pixel = 2.0 / height;  // metres
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const double xWorld = (x + 0.5 - width / 2) * pixel;
        const float* normal = frame.aovs.at(Aov::Normal).pixel(x, y);
        const bool seen = x >= width / 2;
        EXPECT_EQ(*frame.aovs.at(Aov::Depth).pixel(x, y) < 1e30f, seen);
        EXPECT_NEAR(seen ? *frame.aovs.at(Aov::Depth).pixel(x, y) : 3 + xWorld, 3 + xWorld, 1e-5);
        EXPECT_NEAR(normal[0], seen ? std::numbers::sqrt2 / 2 : 0, 1e-4);
        EXPECT_NEAR(normal[1], 0, 1e-4);
        EXPECT_NEAR(normal[2], seen ? std::numbers::sqrt2 / 2 : 0, 1e-4);
        for (int c = 0; c < 3; ++c) {
          EXPECT_EQ(frame.aovs.at(Aov::Albedo).pixel(x, y)[c], seen ? 0.25f * static_cast<float>(1 << c) : 0);
          EXPECT_EQ(frame.aovs.at(Aov::Transmittance).pixel(x, y)[c], 1);
        }
        for (const Aov count : {Aov::Lights, Aov::Fragments, Aov::ShadowNodes})
          EXPECT_EQ(*frame.aovs.at(count).pixel(x, y), 0);
      }
    }
  }
}

TEST_F(AovsGpu, CoverPixelsInPart) {
  // The wall's edge at a quarter of the pixel's width: the mean of four samples is not all or nothing.
  KnownScene known = slantingWall();
  known.scene.instances[0].worldFromObject[3].x = 0.5 * 2.0 / height;
  const Frame frame = draw(known, smooth(), {.aovs = all});
  const float* albedo = frame.aovs.at(Aov::Albedo).pixel(width / 2, height / 2);
  EXPECT_EQ(albedo[2], 0.5f);
  EXPECT_EQ(albedo[0], 0.125f);
  const float* normal = frame.aovs.at(Aov::Normal).pixel(width / 2, height / 2);
  EXPECT_NEAR(std::hypot(normal[0], normal[1], normal[2]), 1, 1e-4);
}

TEST_F(AovsGpu, CountWhatListsHold) {
  // A floor under the sun and three panes over its left half; a lamp of small reach in one corner.
  KnownScene known;
  known.scene.cameras = {tests::orthographicCamera({0, 5, 0}, {0, 0, 0}, 1, {0, 0, -1})};
  tests::add(known.scene, tests::quad({-3, 0, 3}, {6, 0, 0}, {0, 0, -6}), tests::lambert({1, 1, 1}));
  for (int i = 1; i <= 3; ++i)
    tests::add(known.scene, tests::quad({-3, 0.2f * static_cast<float>(i), 3}, {3, 0, 0}, {0, 0, -6}),
               tests::pane({0.5f, 0.5f, 0.5f}));
  scene::Light lamp = tests::pointLight({1, 0.1, -0.75}, {1, 1, 1});
  lamp.range = 0.3;
  lamp.castsShadow = false;
  known.scene.lights = {tests::directionalLight({0, -1, 0}, {1, 1, 1}), lamp};
  const Frame frame = draw(known, fine, {.aovs = all});
  const auto at = [&](Aov aov, double xWorld, double zWorld) {
    return *frame.aovs.at(aov).pixel(static_cast<int>(width / 2 + xWorld * height / 2),
                                     static_cast<int>(height / 2 + zWorld * height / 2));
  };
  EXPECT_EQ(at(Aov::Fragments, -0.5, 0.3), 3);
  EXPECT_EQ(at(Aov::Fragments, 0.5, 0.3), 0);
  EXPECT_EQ(at(Aov::ShadowNodes, -0.5, 0.3), 3);  // each pane is a step
  EXPECT_EQ(at(Aov::ShadowNodes, 0.5, 0.3), 0);
  EXPECT_EQ(at(Aov::Lights, 1, -0.75), 2);
  EXPECT_EQ(at(Aov::Lights, -0.5, 0.3), 1);
  EXPECT_NEAR(at(Aov::Transmittance, -0.5, 0.3), 0.125, 1e-6);
}

TEST(Aovs, HaveNamesAndLayers) {
  EXPECT_EQ(aovKinds().names.size(), all.size());
  for (const Aov aov : all) EXPECT_EQ(aovKinds().named(aovKinds().nameOf(aov)), aov);
  EXPECT_THROW(aovKinds().named("beauty"), base::Error);
  const image::Layer layer = layerOf(Aov::ShadowNodes, image::Image(1, 1, 1));
  EXPECT_EQ(layer.name, "shadow_nodes");
  for (const auto& [aov, image] : emptyImages(all, 3, 2))
    EXPECT_EQ(layerOf(aov, image).channels.size(), static_cast<size_t>(image.channels));
}

}  // namespace
}  // namespace sfumato::pipelines
