// Filtered lookups in deep shadow maps: no acne and no leaks over light types, angles, resolutions and
// filters; smooth edges; and all light types in one frame under one budget.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/error.h"
#include "image/metrics.h"
#include "pipelines/linked_lists_gpu.h"
#include "pipelines/reference.h"
#include "tests/gl/test_device.h"
#include "tests/pipelines/frame_errors.h"
#include "tests/pipelines/known_scenes.h"

namespace sfumato::pipelines {
namespace {

using glm::dvec3;
using lights::LightType;
using tests::KnownScene;

constexpr int width = 64;
constexpr int height = 48;
constexpr double far = 7;  // of lamps from the middle of things, m

constexpr ShadowFilter filters[] = {ShadowFilter::Nearest, ShadowFilter::Bilinear, ShadowFilter::Soft};
constexpr LightType types[] = {LightType::Directional, LightType::Spot, LightType::Point};
constexpr double elevations[] = {1, 10, 45, 89};  // degrees
constexpr double finestAt = 10;                   // of them, with 2048 texels, too
constexpr double spotAngle = 0.5;

// A light that shines at the origin from `degrees` over the plane y = 0.
scene::Light lightAt(LightType type, double degrees, double azimuth = 0) {
  const double e = glm::radians(degrees);
  const dvec3 to(std::cos(e) * std::cos(azimuth), std::sin(e), std::cos(e) * std::sin(azimuth));
  if (type == LightType::Directional) return tests::directionalLight(-to, dvec3(3));
  if (type == LightType::Point) return tests::pointLight(far * to, dvec3(3 * far * far));
  return tests::spotLight(far * to, dvec3(0), dvec3(3 * far * far), 0.45, spotAngle);
}

class ShadowFilterGpu : public tests::GpuTest {
 protected:
  // Calls `check(frame, without shadows, resolution)` for every filter and resolution.
  template <typename Check>
  void sweep(const KnownScene& known, const std::string& what, const std::vector<int>& resolutions,
             Check check) {
    KnownScene bare = known;
    for (scene::Light& light : bare.scene.lights) light.castsShadow = false;
    const image::Image unshadowed = LinkedListsPipeline(device(), bare.scene, bare.media)
                                        .render(bare.scene.cameras[0], width, height, fine)
                                        .radiance;
    LinkedListsPipeline pipeline(device(), known.scene, known.media);
    for (const ShadowFilter filter : filters) {
      for (const int resolution : resolutions) {
        Quality quality = fine;
        quality.shadowResolution = resolution;
        quality.surfaceShadows = filter;
        const image::Image image = pipeline.render(known.scene.cameras[0], width, height, quality).radiance;
        SCOPED_TRACE(fmt::format("{}, {}, {} texels", what, shadowFilters().nameOf(filter), resolution));
        check(image, unshadowed, resolution);
      }
    }
  }

  template <typename Make, typename Check>
  void sweepLights(Make make, Check check) {
    for (const LightType type : types)
      for (const double degrees : elevations)
        sweep(make(type, degrees), fmt::format("light {} at {} degrees", static_cast<int>(type), degrees),
              degrees == finestAt ? std::vector{64, 256, 1024, 2048} : std::vector{64, 256, 1024},
              [&](const image::Image& image, const image::Image& unshadowed, int resolution) {
                check(image, unshadowed, resolution, type, degrees);
              });
  }
};

// Largest part of what a pixel should have that it lacks; of pixels that have little, part of the brightest.
double worstLack(const image::Image& image, const image::Image& expected) {
  const float brightest = *std::max_element(expected.values.begin(), expected.values.end());
  double worst = 0;
  for (size_t i = 0; i < image.values.size(); ++i) {
    const double whole = std::max(expected.values[i], 0.01f * brightest);
    worst = std::max(worst, std::abs(double(expected.values[i]) - double(image.values[i])) / whole);
  }
  return worst;
}

// The part of all values that are off by more than 2 %.
double partLacking(const image::Image& image, const image::Image& expected) {
  size_t lacking = 0;
  for (size_t i = 0; i < image.values.size(); ++i)
    if (std::abs(image.values[i] - expected.values[i]) > 0.02f * expected.values[i]) ++lacking;
  return static_cast<double>(lacking) / static_cast<double>(image.values.size());
}

TEST_F(ShadowFilterGpu, APlaneIsNotShadowedByItself) {
  double worst = 0;
  sweepLights(
      [](LightType type, double degrees) {
        KnownScene known{"plane", {}, {}};
        tests::add(known.scene, tests::tiledQuad({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}, 5),
                   tests::lambert({1, 1, 1}));
        known.scene.lights = {lightAt(type, degrees, 0.4)};
        known.scene.cameras = {tests::perspectiveCamera({0, 1.5, 4}, {0, 0, 0}, 0.8)};
        return known;
      },
      [&](const image::Image& image, const image::Image& unshadowed, int, LightType, double) {
        const double lack = worstLack(image, unshadowed);
        worst = std::max(worst, lack);
        EXPECT_LT(lack, 1e-5);
      });
  fmt::print("plane: {:.2g}\n", worst);
}

// A floor and two walls that meet at right angles, open to the light: none shadows another.
TEST_F(ShadowFilterGpu, WallsThatMeetDoNotShadowEachOther) {
  double worst = 0;
  double most = 0;
  sweepLights(
      [](LightType type, double degrees) {
        KnownScene known{"corner", {}, {}};
        tests::add(known.scene, tests::quad({-1, -1, 3}, {4, 0, 0}, {0, 0, -4}), tests::lambert({1, 1, 1}));
        tests::add(known.scene, tests::quad({-1, -1, 3}, {0, 0, -4}, {0, 3, 0}), tests::lambert({1, 1, 1}));
        tests::add(known.scene, tests::quad({-1, -1, -1}, {4, 0, 0}, {0, 3, 0}), tests::lambert({1, 1, 1}));
        known.scene.lights = {lightAt(type, degrees, 0.7)};
        known.scene.cameras = {tests::perspectiveCamera({2.5, 1.5, 3}, {-0.5, -0.5, -0.5}, 0.7)};
        return known;
      },
      [&](const image::Image& image, const image::Image& unshadowed, int resolution, LightType, double) {
        if (resolution > 64) {
          const double lack = worstLack(image, unshadowed);
          worst = std::max(worst, lack);
          EXPECT_LT(lack, 1e-4);
        } else {
          // A wall along the light is narrower than two texels, which then cannot tell that it joins the
          // floor.
          const double part = partLacking(image, unshadowed);
          most = std::max(most, part);
          EXPECT_LT(part, 0.15);  // measured: 0.122, soft, straight from above
        }
      });
  fmt::print("corner: {:.2g}, with 64 texels in {:.3f} of the pixels\n", worst, most);
}

TEST_F(ShadowFilterGpu, ABallIsShadowedByItselfOnlyWhereItTurnsAway) {
  double worst = 0;
  sweepLights(
      [](LightType type, double degrees) {
        KnownScene known{"ball", {}, {}};
        scene::Material closed = tests::lambert({1, 1, 1});
        closed.doubleSided = false;
        tests::add(known.scene, tests::sphere(48, 96), closed);
        known.scene.lights = {lightAt(type, degrees, 0.4)};
        known.scene.cameras = {tests::perspectiveCamera({0, 1, 4}, {0, 0, 0}, 0.6)};
        return known;
      },
      [&](const image::Image& image, const image::Image& unshadowed, int, LightType, double) {
        // In units of what faces the light.
        double lack = 0;
        for (size_t i = 0; i < image.values.size(); ++i)
          lack = std::max(lack, double(unshadowed.values[i]) - double(image.values[i]));
        lack /= 3 / std::numbers::pi;
        worst = std::max(worst, lack);
        EXPECT_LT(lack, 0.012);  // beside the terminator; measured: 0.0082
      });
  fmt::print("ball: {:.2g}\n", worst);
}

// A wall without a thickness stands on the floor across the light. Seen from above: behind it is dark and
// before it lit, but for the width of the kernel around the outline of the shadow.
TEST_F(ShadowFilterGpu, BehindAThinWallItIsDark) {
  constexpr double wallHeight = 2;
  constexpr double half = 2.2;  // of the image's height, m
  size_t dark = 0;
  size_t lit = 0;
  sweepLights(
      [](LightType type, double degrees) {
        KnownScene known{"thin wall", {}, {}};
        tests::add(known.scene, tests::quad({-6, 0, 6}, {12, 0, 0}, {0, 0, -12}), tests::lambert({1, 1, 1}));
        tests::add(known.scene, tests::quad({0, 0, -5}, {0, 0, 10}, {0, wallHeight, 0}),
                   tests::lambert({1, 1, 1}));
        known.scene.lights = {lightAt(type, degrees)};
        known.scene.cameras = {tests::orthographicCamera({-1, 10, 0}, {-1, 0, 0}, half, {0, 0, -1})};
        return known;
      },
      [&](const image::Image& image, const image::Image& unshadowed, int resolution, LightType type,
          double degrees) {
        const double e = glm::radians(degrees);
        // A texel across the light, at its widest; the image is 5.9 m wide, and the wall is in it.
        const double texel = (type == LightType::Directional ? 8.0
                              : type == LightType::Spot      ? 2 * (far + 4) * std::tan(spotAngle)
                                                             : 4 * (far + 4)) /
                             (resolution - 4);
        const double kernel = 3 * texel / std::sin(e);  // on the floor
        // Where the shadow ends: the ray over the top.
        const double top = type == LightType::Directional
                               ? wallHeight / std::tan(e)
                               : wallHeight * far * std::cos(e) / (far * std::sin(e) - wallHeight);
        const double end = top > 0 ? top : 1e9;  // the lamp stands lower than the wall
        for (int y = 0; y < height; ++y) {
          for (int x = 0; x < width; ++x) {
            const double px = -1 + (2 * (x + 0.5) / width - 1) * half * width / height;
            const float value = image.pixel(x, y)[0];
            const float whole = unshadowed.pixel(x, y)[0];
            const bool inShadow = px < -kernel && px > -end + kernel;
            if (inShadow && whole > 0) {
              ++dark;
              EXPECT_LE(value, 0.f) << px;
            }
            // Before the wall, but for the pixels that its edge is seen in.
            if (px > 0.1 && whole > 0) {
              ++lit;
              EXPECT_NEAR(value / whole, 1, 0.01) << px;  // measured: 0.006
            }
          }
        }
      });
  EXPECT_GT(dark, 20000u);
  EXPECT_GT(lit, 20000u);
}

// RMS of what the values are off the straight line that fits them best.
double offStraight(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double slope = 0;
  double spread = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    const double x = static_cast<double>(i) - (n - 1) / 2;
    slope += x * (values[i] - mean);
    spread += x * x;
  }
  slope /= spread;
  double sum = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    const double off = values[i] - mean - slope * (static_cast<double>(i) - (n - 1) / 2);
    sum += off * off;
  }
  return std::sqrt(sum / n);
}

// The shadow's edge of a slanting pole: how far neighbouring rows of its outline are off a straight line. A
// wider kernel leaves less of the texels.
TEST_F(ShadowFilterGpu, AWiderKernelMakesStraighterEdges) {
  KnownScene known{"edge", {}, {}};
  tests::add(known.scene, tests::quad({-3, 0, 3}, {6, 0, 0}, {0, 0, -6}), tests::lambert({1, 1, 1}));
  const dvec3 along(std::sin(0.3), 0, std::cos(0.3));
  const dvec3 across(std::cos(0.3), 0, -std::sin(0.3));
  tests::add(
      known.scene,
      tests::quad(glm::vec3(-3.0 * along + dvec3(0, 1, 0)), glm::vec3(6.0 * along), glm::vec3(4.0 * across)),
      tests::lambert({1, 1, 1}));
  known.scene.lights = {tests::directionalLight({0, -1, 0}, dvec3(3))};
  // From below it, so that the floor is seen.
  known.scene.cameras = {tests::orthographicCamera({0, 0.9, 0}, {0, 0, 0}, 0.8, {0, 0, -1})};
  LinkedListsPipeline pipeline(device(), known.scene, known.media);
  double roughness[3] = {};
  for (const ShadowFilter filter : filters) {
    Quality quality = fine;
    quality.shadowResolution = 32;
    quality.surfaceShadows = filter;
    const image::Image image = pipeline.render(known.scene.cameras[0], 128, 96, quality).radiance;
    // The light in a row is where the edge crosses it; what is off a straight line is the texels'.
    std::vector<double> crossing;
    for (int y = 0; y < 96; ++y) {
      double sum = 0;
      for (int x = 0; x < 128; ++x) sum += image.pixel(x, y)[0] * std::numbers::pi / 3;
      crossing.push_back(sum);
    }
    roughness[static_cast<size_t>(filter)] = offStraight(crossing);
  }
  fmt::print("edge, pixels: nearest {:.3f}, bilinear {:.3f}, soft {:.3f}\n", roughness[0], roughness[1],
             roughness[2]);
  EXPECT_LT(roughness[1], 0.85 * roughness[0]);
  EXPECT_LT(roughness[2], 0.9 * roughness[1]);
}

// Sun, spot, wide spot and point light, each through smoke and panes, in one frame: against the reference,
// with maps as large as they want to be and with all of them in a tenth of that.
TEST_F(ShadowFilterGpu, AllLightTypesShareOneFrameAndOneBudget) {
  KnownScene known = tests::smokeAndGlass();
  known.scene.lights.push_back(tests::spotLight({1.5, 3, 1.5}, {0, 0, 0}, dvec3(8), 0.4, 1.3));
  const image::Image expected =
      renderReference(known.scene, known.scene.cameras[0], known.media, {.width = width, .height = height});
  LinkedListsPipeline pipeline(device(), known.scene, known.media);
  Quality quality = fine;
  quality.exactShadowResolution = quality.exactShadowError = false;
  quality.shadowResolution = 4096;  // as large as what lights cover asks: 64 pixels
  const Frame whole = pipeline.render(known.scene.cameras[0], width, height, quality);
  const PixelErrors found = compareFrames("all lights", whole.radiance, expected);
  EXPECT_LT(found.failingFraction, 0.02);
  EXPECT_NEAR(found.meanRatio, 1.0, 0.003);
  EXPECT_FALSE(whole.statistics.shadowMaps.lowered);
  quality.shadowMemory = whole.statistics.shadowMaps.bytes / 10;
  const Frame fitted = pipeline.render(known.scene.cameras[0], width, height, quality);
  EXPECT_LE(fitted.statistics.shadowMaps.bytes, quality.shadowMemory);
  EXPECT_TRUE(fitted.statistics.shadowMaps.lowered);
  const PixelErrors coarse = compareFrames("all lights in a tenth", fitted.radiance, expected);
  EXPECT_LT(coarse.failingFraction, 0.06);
  EXPECT_NEAR(coarse.meanRatio, 1.0, 0.01);
}

}  // namespace
}  // namespace sfumato::pipelines
