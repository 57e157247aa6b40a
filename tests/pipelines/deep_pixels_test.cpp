// Samples of deep pixels from what rays met: known answers, and what compositing into smoke may be off by.
#include "pipelines/deep_pixels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "base/random.h"
#include "tests/image/deep_compositing.h"

namespace sfumato::pipelines {
namespace {

using glm::dvec3;
using image::DeepSample;
using test::composite;
using test::compositeUpTo;

// Makes the events of a ray, as the walk would.
class Ray {
 public:
  Ray& surface(float depth, const dvec3& radiance, const dvec3& pass) {
    return add(depth, depth, throughput_ * radiance, pass);
  }
  // Homogeneous, of optical depth `tau`, with source radiance `source`.
  Ray& smoke(float front, float back, const dvec3& tau, const dvec3& source) {
    return add(front, back, throughput_ * source * (1.0 - glm::exp(-tau)), glm::exp(-tau));
  }
  // In steps of `step`; tau(depth) is per metre.
  Ray& smoke(float front, float back, float step, const std::function<double(double)>& sigma,
             const std::function<dvec3(double)>& source) {
    for (float at = front; at + step <= back + 1e-4f; at += step)
      smoke(at, at + step, dvec3(sigma(at + 0.5 * step) * step), source(at + 0.5 * step));
    return *this;
  }
  const RayEvents& events() const { return events_; }

 private:
  Ray& add(float front, float back, const dvec3& added, const dvec3& pass) {
    throughput_ *= pass;
    events_.push_back({0, front, back, static_cast<float>(added.x), static_cast<float>(added.y),
                       static_cast<float>(added.z), static_cast<float>(throughput_.x),
                       static_cast<float>(throughput_.y), static_cast<float>(throughput_.z)});
    return *this;
  }
  dvec3 throughput_{1};
  RayEvents events_;
};

std::vector<DeepSample> join(const std::vector<Ray>& rays, double error = deepError) {
  std::vector<RayEvents> events;
  for (const Ray& ray : rays) events.push_back(ray.events());
  return joinRays(events, error);
}

struct Seen {
  dvec3 radiance{0};
  dvec3 passed{0};
};

// The truth: the mean over the rays of what each gathered up to a depth.
Seen meanUpTo(const std::vector<Ray>& rays, double depth) {
  Seen mean;
  for (const Ray& ray : rays) {
    dvec3 radiance(0);
    dvec3 passed(1);
    for (const shared::DeepEvent& event : ray.events()) {
      const dvec3 added(event.addedR, event.addedG, event.addedB);
      const dvec3 after(event.throughputR, event.throughputG, event.throughputB);
      if (event.front >= depth) break;
      const double part =
          event.back <= depth ? 1 : (depth - event.front) / (double(event.back) - event.front);
      for (int c = 0; c < 3; ++c) {
        const double tau = -std::log(after[c] / passed[c]);
        radiance[c] += added[c] * (part < 1 ? std::expm1(-tau * part) / std::expm1(-tau) : 1);
        passed[c] = part < 1 ? passed[c] * std::exp(-tau * part) : after[c];
      }
    }
    mean.radiance += radiance / double(rays.size());
    mean.passed += passed / double(rays.size());
  }
  return mean;
}

// Most that a white card at any depth would be off by, of itself and of the pixel.
double worstCard(const std::vector<Ray>& rays, const std::vector<DeepSample>& samples, double from,
                 double to) {
  const dvec3 all = meanUpTo(rays, 1e9).radiance;
  const double brightest = std::max({all.x, all.y, all.z});
  double worst = 0;
  for (int i = 1; i < 1000; ++i) {
    const double depth = from + (to - from) * i / 1000.0;
    const Seen truth = meanUpTo(rays, depth);
    const auto got = compositeUpTo(samples, depth);
    const double mean = (truth.passed.x + truth.passed.y + truth.passed.z) / 3;
    worst = std::max(worst, std::abs(got.passed - mean));
    for (int c = 0; c < 3; ++c) {
      worst = std::max(worst, std::abs(got.passedOfEach[c] - truth.passed[c]));
      worst = std::max(worst, std::abs(got.colour[c] - truth.radiance[c]) / brightest);
    }
  }
  return worst;
}

void expectFlattens(const std::vector<Ray>& rays, const std::vector<DeepSample>& samples) {
  const Seen truth = meanUpTo(rays, 1e9);
  const auto got = composite(samples);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(got.colour[c], truth.radiance[c], 1e-6 * (1 + truth.radiance[c])) << c;
    EXPECT_NEAR(got.passedOfEach[c], truth.passed[c], 1e-6) << c;
  }
  for (size_t i = 0; i < samples.size(); ++i) {
    EXPECT_LE(samples[i].z, samples[i].zBack);
    if (i > 0) {
      EXPECT_LE(samples[i - 1].zBack, samples[i].z);
    }
  }
}

TEST(DeepPixels, NothingIsNoSample) {
  EXPECT_TRUE(join({Ray()}).empty());
  EXPECT_TRUE(join({Ray(), Ray(), Ray(), Ray()}).empty());
}

TEST(DeepPixels, SurfacesAreSamplesOfNoLength) {
  const Ray ray = Ray().surface(1, {0.5, 0.25, 0}, dvec3(0.75)).surface(2, {4, 4, 4}, dvec3(0));
  const auto samples = join({ray});
  ASSERT_EQ(samples.size(), 2u);
  EXPECT_EQ(samples[0].z, 1);
  EXPECT_EQ(samples[0].zBack, 1);
  EXPECT_FLOAT_EQ(samples[0].alpha, 0.25f);
  EXPECT_FLOAT_EQ(samples[0].colour[0], 0.5f);
  EXPECT_FLOAT_EQ(samples[0].colour[1], 0.25f);
  EXPECT_EQ(samples[1].z, 2);
  EXPECT_EQ(samples[1].alpha, 1);
  EXPECT_FLOAT_EQ(samples[1].colour[2], 4);  // not dimmed by the first
}

TEST(DeepPixels, HomogeneousSmokeIsOneSample) {
  const auto sigma = [](double) { return 0.7; };
  const Ray ray = Ray().smoke(2, 5, 0.0625f, sigma, [](double) { return dvec3(3, 2, 1); });
  const auto samples = join({ray});
  ASSERT_EQ(samples.size(), 1u);
  EXPECT_FLOAT_EQ(samples[0].z, 2);
  EXPECT_FLOAT_EQ(samples[0].zBack, 5);
  const double alpha = 1 - std::exp(-0.7 * 3);
  EXPECT_NEAR(samples[0].alpha, alpha, 1e-5);
  EXPECT_NEAR(samples[0].colour[0], 3 * alpha, 1e-5);
  EXPECT_NEAR(samples[0].colour[2], alpha, 1e-5);
}

TEST(DeepPixels, SmokeThatTakesNothingGlowsEvenly) {
  Ray ray;
  for (float z = 1; z < 3; z += 0.25f) ray.surface(z, dvec3(0), dvec3(1));  // nothing at all
  EXPECT_TRUE(join({ray}).empty());
  RayEvents glow;
  for (float z = 1; z < 3; z += 0.25f) glow.push_back({0, z, z + 0.25f, 0.125f, 0, 0, 1, 1, 1});
  const auto samples = joinRays(std::span(&glow, 1));
  ASSERT_EQ(samples.size(), 1u);
  EXPECT_EQ(samples[0].alpha, 0);
  EXPECT_FLOAT_EQ(samples[0].colour[0], 1);
  EXPECT_NEAR(compositeUpTo(samples, 1.5).colour.x, 0.25, 1e-6);
}

TEST(DeepPixels, NoSampleCrossesASurfaceOrEmptiness) {
  const auto thin = [](double) { return 0.5; };
  const auto white = [](double) { return dvec3(1); };
  const Ray ray = Ray()
                      .smoke(1, 2, 0.125f, thin, white)
                      .surface(2, dvec3(1), dvec3(0.5))
                      .smoke(2, 3, 0.125f, thin, white)
                      .smoke(8, 9, 0.125f, thin, white);
  const auto samples = join({ray});
  ASSERT_EQ(samples.size(), 4u);
  EXPECT_EQ(samples[1].z, samples[1].zBack);
  EXPECT_EQ(samples[2].zBack, 3);
  EXPECT_EQ(samples[3].z, 8);
  expectFlattens({ray}, samples);
}

TEST(DeepPixels, RaysThatDifferAreOneMean) {
  const std::vector<Ray> rays = {Ray().surface(1, dvec3(8), dvec3(0)), Ray().surface(3, dvec3(4), dvec3(0)),
                                 Ray().surface(1, dvec3(8), dvec3(0)), Ray()};
  const auto samples = join(rays);
  ASSERT_EQ(samples.size(), 2u);
  EXPECT_FLOAT_EQ(samples[0].alpha, 0.5f);
  EXPECT_FLOAT_EQ(samples[0].colour[0], 4);
  EXPECT_FLOAT_EQ(samples[1].alpha, 0.5f);  // of the half that is left
  EXPECT_FLOAT_EQ(samples[1].colour[0], 2);
  expectFlattens(rays, samples);
}

TEST(DeepPixels, ColouredGlassTakesEachColour) {
  const std::vector<Ray> rays = {Ray()
                                     .surface(1, dvec3(0.1), {0.9, 0.5, 0})
                                     .surface(2, dvec3(0.2), {0.5, 0, 1})
                                     .surface(3, dvec3(7), dvec3(0))};
  const auto samples = join(rays);
  ASSERT_EQ(samples.size(), 3u);
  EXPECT_FLOAT_EQ(samples[0].takes[0], 0.1f);
  EXPECT_FLOAT_EQ(samples[0].takes[1], 0.5f);
  EXPECT_FLOAT_EQ(samples[0].takes[2], 1);
  EXPECT_NEAR(samples[0].alpha, 1 - (0.9 + 0.5) / 3, 1e-6);
  EXPECT_NEAR(samples[1].alpha, 1 - 0.45 / 1.4, 1e-6);
  expectFlattens(rays, samples);
}

// Rays with bumps of smoke, shadows in it, and surfaces between.
std::vector<Ray> cloudyRays(base::Random& random, int count, double density, bool coloured) {
  const double phase = random.uniform();
  const auto sigma = [=](double z) { return density * std::pow(std::sin(3 * z + 6 * phase), 4); };
  const auto light = [=](double z) { return z > 2.5 + phase ? dvec3(5, 4, 3) : dvec3(0.2, 0.3, 0.4); };
  const auto first = static_cast<float>(2.3 + 0.1 * random.uniform());
  std::vector<Ray> rays(static_cast<size_t>(count));
  for (Ray& ray : rays) {
    ray.smoke(1, first, 0.03f, sigma, light);
    ray.surface(first, dvec3(random.uniform()), coloured ? dvec3(0.9, 0.6, 0.3) : dvec3(0.8));
    if (coloured) ray.smoke(first, first + 0.2f, {0.1, 0.3, 0.9}, {1, 2, 3});
    ray.smoke(first + 0.2f, 4, 0.03f, sigma, light);
    if (random.uniform() < 0.5) ray.surface(static_cast<float>(4 + random.uniform()), dvec3(2), dvec3(0));
  }
  return rays;
}

TEST(DeepPixels, ACardInSmokeIsWithinTheBound) {
  base::Random random(7);
  size_t kept = 0;
  size_t events = 0;
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(i);
    const double density = std::pow(10.0, 3 * random.uniform() - 1.5);
    const auto rays = cloudyRays(random, i % 2 == 0 ? 1 : 4, density, i % 3 == 0);
    const auto samples = join(rays);
    expectFlattens(rays, samples);
    EXPECT_LE(worstCard(rays, samples, 0.5, 6), deepError);
    kept += samples.size();
    events += rays.front().events().size();
  }
  EXPECT_LT(kept, events / 2);
}

TEST(DeepPixels, ALooserBoundIsSeen) {
  base::Random random(7);
  const auto rays = cloudyRays(random, 1, 3, false);
  EXPECT_GT(worstCard(rays, join(rays, 0.1), 0.5, 6), 4 * deepError);
  EXPECT_LT(join(rays, 0.1).size(), join(rays).size());
  EXPECT_GT(join(rays, 0).size(), join(rays).size());
}

TEST(DeepPixels, ATexelsKnotsAreBlackSamples) {
  const std::vector<shared::ShadowKnot> knots = {
      {1, 0, 0, 0}, {2, 0.5f, 0.5f, 0.5f}, {2, 1, 1.5f, 2}, {3, 1, 1.5f, 2}, {5, 2, 2.5f, 3}};
  const auto samples = samplesOf(knots, 6);
  ASSERT_EQ(samples.size(), 4u);
  EXPECT_EQ(samples[0].z, 1);
  EXPECT_EQ(samples[0].zBack, 2);
  EXPECT_NEAR(samples[0].takes[1], 1 - std::exp(-0.5), 1e-6);
  EXPECT_EQ(samples[1].z, samples[1].zBack);
  EXPECT_NEAR(samples[1].takes[0], 1 - std::exp(-0.5), 1e-6);
  EXPECT_NEAR(samples[1].takes[2], 1 - std::exp(-1.5), 1e-6);
  EXPECT_EQ(samples[2].z, 3);
  EXPECT_EQ(samples[2].zBack, 5);
  EXPECT_EQ(samples[3].z, 6);
  EXPECT_EQ(samples[3].alpha, 1);
  for (const double depth : {0.5, 1.5, 2.5, 4.0, 5.5, 7.0}) {
    const double tau = depth < 1   ? 0
                       : depth < 2 ? 0.5 * (depth - 1)
                       : depth < 3 ? 1
                       : depth < 5 ? 1 + 0.5 * (depth - 3)
                                   : 2;
    EXPECT_NEAR(compositeUpTo(samples, depth).passedOfEach.x, depth > 6 ? 0 : std::exp(-tau), 1e-6) << depth;
  }
  for (const DeepSample& sample : samples) EXPECT_EQ(sample.colour, (std::array<float, 3>{}));
}

TEST(DeepPixels, BehindTheOpaqueDepthThereIsNothing) {
  const std::vector<shared::ShadowKnot> knots = {{1, 0, 0, 0}, {2, 1, 1, 1}, {4, 3, 3, 3}};
  const auto samples = samplesOf(knots, 2.5f);
  ASSERT_EQ(samples.size(), 2u);
  EXPECT_EQ(samples[1].z, 2.5f);
  EXPECT_EQ(samples[1].zBack, 2.5f);
  EXPECT_TRUE(samplesOf({}, 3e38f).empty());
  EXPECT_EQ(samplesOf({}, 2).size(), 1u);
}

}  // namespace
}  // namespace sfumato::pipelines
