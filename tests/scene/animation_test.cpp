#include "scene/animation.h"

#include <gtest/gtest.h>

#include <cmath>

namespace sfumato::scene {
namespace {

void expectValue(const Keyframes& keyframes, double seconds, const std::vector<double>& expected) {
  const std::vector<double> value = valueAt(keyframes, seconds);
  ASSERT_EQ(value.size(), expected.size());
  for (size_t i = 0; i < value.size(); ++i)
    EXPECT_NEAR(value[i], expected[i], 1e-6) << "number " << i << " at " << seconds;
}

TEST(Animation, LinearBetweenKeysAndHeldAtTheEnds) {
  const Keyframes k{.width = 2, .times = {1, 2, 4}, .values = {0, 10, 8, 20, 4, -20}};
  expectValue(k, -5, {0, 10});
  expectValue(k, 1, {0, 10});
  expectValue(k, 1.25, {2, 12.5});
  expectValue(k, 2, {8, 20});
  expectValue(k, 3, {6, 0});
  expectValue(k, 4, {4, -20});
  expectValue(k, 1e9, {4, -20});
}

TEST(Animation, OneKeyHoldsAlways) {
  for (const Interpolation interpolation : {Interpolation::Step, Interpolation::Linear})
    for (const double seconds : {-1., 3., 7.})
      expectValue({.interpolation = interpolation, .times = {3}, .values = {5}}, seconds, {5});
  const Keyframes cubic{.interpolation = Interpolation::CubicSpline, .times = {3}, .values = {9, 5, 9}};
  for (const double seconds : {-1., 3., 7.}) expectValue(cubic, seconds, {5});
}

TEST(Animation, StepHoldsUntilTheNextKey) {
  const Keyframes k{.interpolation = Interpolation::Step, .times = {0, 1, 2}, .values = {3, 4, 5}};
  expectValue(k, 0.999, {3});
  expectValue(k, 1, {4});
  expectValue(k, 1.5, {4});
  expectValue(k, 2, {5});
}

// Half an unevenly weighted way round: quaternions of a turn about Z by 20 and by 100 degrees.
TEST(Animation, RotationsTurnAtConstantSpeedTheShortWay) {
  const auto aboutZ = [](double degrees) {
    const double half = degrees * M_PI / 360;
    return std::array<float, 4>{0, 0, static_cast<float>(std::sin(half)), static_cast<float>(std::cos(half))};
  };
  const auto keyframes = [&](const std::array<float, 4>& from, const std::array<float, 4>& to) {
    Keyframes k{.rotation = true, .width = 4, .times = {0, 4}, .values = {}};
    k.values.insert(k.values.end(), from.begin(), from.end());
    k.values.insert(k.values.end(), to.begin(), to.end());
    return k;
  };
  const auto expected = aboutZ(40);
  expectValue(keyframes(aboutZ(20), aboutZ(100)), 1, {expected.begin(), expected.end()});
  auto other = aboutZ(100);  // the same turn as a quaternion, on the far side
  for (float& c : other) c = -c;
  expectValue(keyframes(aboutZ(20), other), 1, {expected.begin(), expected.end()});
}

// A cubic that keys with its own values and slopes must follow exactly: p(t) = t^3 - 2 t^2 + 3.
TEST(Animation, CubicSplinesReproduceCubics) {
  const auto p = [](double t) { return t * t * t - 2 * t * t + 3; };
  const auto slope = [](double t) { return 3 * t * t - 4 * t; };
  Keyframes k{.interpolation = Interpolation::CubicSpline, .times = {0, 0.5f, 2, 3}, .values = {}};
  for (const float t : k.times)
    for (const double v : {slope(t), p(t), slope(t)}) k.values.push_back(static_cast<float>(v));
  for (double t = 0; t <= 3; t += 0.125) expectValue(k, t, {p(t)});
  expectValue(k, -1, {p(0)});
  expectValue(k, 4, {p(3)});
}

TEST(Animation, CubicSplinesTakeTheRightTangents) {
  // Two numbers: in-tangent, value and out-tangent of the first key, then of the second. At the middle a
  // Hermite segment of length d is (a + b) / 2 + d (out - in) / 8.
  const Keyframes k{.interpolation = Interpolation::CubicSpline,
                    .width = 2,
                    .times = {1, 3},
                    .values = {100, 100, 1, 2, 8, 16, 4, 0, 3, 4, 100, 100}};
  expectValue(k, 2, {2 + 2 * (8 - 4) / 8.0, 3 + 2 * 16 / 8.0});
}

}  // namespace
}  // namespace sfumato::scene
