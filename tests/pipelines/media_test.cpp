// What media do to light, by the CPU reference against known answers.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/random.h"
#include "pipelines/quality.h"
#include "pipelines/reference.h"
#include "tests/pipelines/media_scenes.h"
#include "volumes/reference_march.h"

namespace sfumato::pipelines {
namespace {

using glm::dvec3;
using tests::KnownScene;

constexpr double pi = std::numbers::pi;
constexpr double storedAsFloat = 2e-7;  // relative: the picture's own rounding
const dvec3 wallRadiance(0.5, 1, 2);

// Steps of half a voxel that end at the kinks of a block's profile, where the march is exact; a hair longer,
// so that rounding adds no step.
const ReferenceOptions exact{
    .width = 4, .height = 3, .stepVoxels = 0.5 + 1e-9, .shadowStepVoxels = 0.5 + 1e-9};

image::Image render(const KnownScene& known, const ReferenceOptions& options = exact) {
  return renderReference(known.scene, known.scene.cameras[0], known.media, options);
}

void expectEverywhere(const image::Image& image, const dvec3& expected, double relative) {
  for (size_t i = 0; i < image.values.size(); ++i)
    EXPECT_NEAR(image.values[i], expected[static_cast<int>(i % 3)],
                relative * expected[static_cast<int>(i % 3)])
        << "value " << i;
}

TEST(Media, AColouredSlabLetsExpOfMinusDepthThroughInEachChannel) {
  expectEverywhere(render(tests::colouredSlab()), wallRadiance * dvec3(std::exp(-1.5), std::exp(-0.75), 1),
                   storedAsFloat);
}

TEST(Media, OverlappingColoursAdd) {
  const auto phase = [](double g) { return (1 - g * g) / (4 * pi * std::pow(1 + g * g + 1.6 * g, 1.5)); };
  const dvec3 first = 1.5 * dvec3(1, 0.5, 0);
  const dvec3 second = 0.5 * dvec3(0.25, 4, 0);
  const dvec3 sigma = first + second + dvec3(0, 0, 1e-30);  // there is no blue extinction
  const dvec3 scattering =
      first * dvec3(0.9, 0.6, 0.3) * phase(0.4) + second * dvec3(0.2, 0.4, 0.8) * phase(-0.3);
  const dvec3 passing = glm::exp(-sigma);
  expectEverywhere(render(tests::overlappingColours()),
                   scattering / sigma * dvec3(4, 5, 6) * (1.0 - passing) + passing * wallRadiance,
                   storedAsFloat);
}

TEST(Media, ColouredSmokeCastsAColouredShadow) {
  // Steps of the light's march end within a step of the kinks: step^2 / 2 in voxels, each 1/16 m of 1.6 / m
  // at most.
  const ReferenceOptions options = {.width = 4, .height = 3, .shadowStepVoxels = 0.05};
  expectEverywhere(render(tests::colouredShadow(), options),
                   dvec3(0.75, 0.5, 0.25) / pi * dvec3(4, 5, 6) * 0.8 * glm::exp(-dvec3(0, 0.5, 2)), 4e-4);
}

// --- Fire ---

// e / sigma (1 - exp(-sigma d)); where nothing takes light, e d.
TEST(Fire, AnEvenlyBurningSlabGlowsThroughItsOwnSmoke) {
  const dvec3 passing(std::exp(-1.5), std::exp(-0.75), 1);
  const dvec3 seen((1 - passing.r) / 1.5, (1 - passing.g) / 0.75, 1);
  expectEverywhere(render(tests::burningSlab()), dvec3(3, 2, 1) * seen + passing * wallRadiance,
                   storedAsFloat);
}

TEST(Fire, GlowsWhereThereIsNoSmoke) {
  expectEverywhere(render(tests::fireBehindSmoke()), std::exp(-0.75) * (dvec3(3, 2, 1) + wallRadiance),
                   storedAsFloat);
  KnownScene known = tests::burningSlab();
  known.media[0].scale = 0;
  expectEverywhere(render(known), dvec3(3, 2, 1) + wallRadiance, storedAsFloat);
}

// --- Multiple scattering ---

volumes::Medium mediumOf(const dvec3& albedo, double g) {
  return {.albedo = albedo, .g = g};
}

TEST(MultipleScattering, OfNoOctaveIsSingleScattering) {
  const volumes::Medium medium = mediumOf({0.9, 0.5, 0.1}, 0.6);
  const dvec3 passing(0.8, 0.3, 0);
  EXPECT_EQ(volumes::turnedLight(medium, 0.3, passing, 0),
            passing * volumes::phaseHenyeyGreenstein(0.3, 0.6));
}

TEST(MultipleScattering, AddsNothingWhereNothingWasTakenAndNothingInTheDark) {
  const volumes::Medium medium = mediumOf({1, 0.5, 0}, 0.6);
  for (int octaves = 0; octaves <= maxScatteringOctaves; ++octaves) {
    EXPECT_EQ(volumes::turnedLight(medium, 0.3, dvec3(1), octaves),
              dvec3(volumes::phaseHenyeyGreenstein(0.3, 0.6)));
    EXPECT_EQ(volumes::turnedLight(medium, 0.3, dvec3(0), octaves), dvec3(0));
  }
}

// Over all directions, at every g.
TEST(MultipleScattering, TurnsNoMoreThanThereWouldBeWithoutSmoke) {
  for (const double g : {-0.6, 0.0, 0.9})
    for (const double passing : {1e-9, 0.01, 0.5, 0.99}) {
      dvec3 before(passing);
      for (const int octaves : {1, usualScatteringOctaves, maxScatteringOctaves}) {
        const volumes::Medium medium = mediumOf({1, 0.5, 0}, g);
        dvec3 sum(0);
        const int parts = g > 0.5 ? 50000 : 5000;
        for (int i = 0; i < parts; ++i)
          sum += volumes::turnedLight(medium, (2 * i + 1.0) / parts - 1, dvec3(passing), octaves) *
                 (4 * pi / parts);
        EXPECT_LE(sum.x, 1);
        EXPECT_GT(sum.x, before.x);
        EXPECT_LT(sum.y, sum.x);
        EXPECT_NEAR(sum.z, passing, 1e-5 * passing) << "what absorbs everything scatters once";
        before = sum;
      }
    }
}

// A slab lit from the front: the sum over octaves of closed integrals of exp(-(1 + depth) s).
TEST(MultipleScattering, OfASlabLitFromTheFront) {
  KnownScene known = tests::smokeBeforePane();
  known.scene.instances.clear();
  known.scene.lights = {tests::directionalLight({0, 0, -1}, {4, 5, 6})};
  const auto lit = [](double depth) { return (1 - std::exp(-1.5 * (1 + depth))) / (1 + depth); };
  dvec3 expected(0);
  for (int i = 0; i <= 3; ++i) {
    const double g = 0.4 * std::pow(0.5, i);
    const double phase = (1 - g * g) / (4 * pi * std::pow(1 + g * g + 2 * g, 1.5));
    const double added = i == 0 ? lit(1) : lit(std::pow(0.5, i)) - lit(std::pow(0.5, i - 1));
    const dvec3 albedo(0.9, 0.6, 0.3);
    expected += albedo * glm::pow(0.7 * albedo, dvec3(i)) * dvec3(4, 5, 6) * phase * added;
  }
  // As the reference's own SlabLitFromTheFront.
  expectEverywhere(
      render(known,
             {.width = 4, .height = 3, .stepVoxels = 0.25, .shadowStepVoxels = 0.05, .scatteringOctaves = 3}),
      expected, 1e-4);
}

// Light in a surround of radiance 1 is 1 everywhere; smoke that absorbs nothing must not make more of it.
TEST(MultipleScattering, AFurnaceGetsNoBrighterThanItsWalls) {
  const KnownScene known = tests::furnace(48);
  ReferenceOptions options{
      .width = 12, .height = 12, .stepVoxels = 1, .shadowStepVoxels = 1, .aovs = {Aov::Transmittance}};
  std::vector<float> before(12 * 12 * 3, 0.f);
  for (const int octaves : {0, 2, maxScatteringOctaves}) {
    options.scatteringOctaves = octaves;
    const ReferenceFrame frame = traceReference(known.scene, known.scene.cameras[0], known.media, options);
    const std::vector<float>& behind = frame.aovs.at(Aov::Transmittance).values;
    for (size_t i = 0; i < behind.size(); ++i) {
      const float seen = frame.radiance.values[i] + behind[i];  // the surround shines through
      EXPECT_LE(seen, 1 + 1e-6f);
      EXPECT_GE(seen, before[i]);
      before[i] = seen;
    }
  }
  EXPECT_GT(before[3 * (6 * 12 + 6)], 0.5f);  // nearly as bright as it should be
}

// Scattering events of light that falls straight into a slab, a unit of light: the walks of photons tell the
// truth.
double eventsInSlab(double depth, double albedo) {
  base::Random random(3);
  constexpr int photons = 20000;
  double events = 0;
  for (int i = 0; i < photons; ++i) {
    double at = 0, cosine = 1, weight = 1;
    for (;;) {
      at += cosine * -std::log(1 - random.uniform(0, 1));
      if (at <= 0 || at >= depth || weight < 1e-3) break;
      events += weight;
      weight *= albedo;
      cosine = random.uniform(-1, 1);
    }
  }
  return events / photons;
}

TEST(MultipleScattering, StaysBelowWhatPhotonsDoInSlabs) {
  for (const double depth : {0.25, 1.0, 4.0, 16.0})
    for (const double albedo : {0.3, 0.6, 0.9, 1.0}) {
      const auto events = [&](int octaves) {
        constexpr int parts = 2000;
        double sum = 0;
        for (int i = 0; i < parts; ++i) {
          const dvec3 passing(std::exp(-depth * (i + 0.5) / parts));
          sum += volumes::turnedLight(mediumOf(dvec3(albedo), 0), 0, passing, octaves).x * 4 * pi * depth /
                 parts;
        }
        return sum;
      };
      const double truth = eventsInSlab(depth, albedo);
      EXPECT_LT(events(usualScatteringOctaves), 1.01 * truth)
          << depth << ", albedo " << albedo;  // their noise: 0.5 %
      EXPECT_GT(events(usualScatteringOctaves), events(0)) << depth << ", albedo " << albedo;
    }
}

}  // namespace
}  // namespace sfumato::pipelines
