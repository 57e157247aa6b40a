#include "image/tone_map.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <limits>

#include "base/random.h"

namespace sfumato::image {
namespace {

Image onePixel(float r, float g, float b) {
  Image image(1, 1, 3);
  image.values = {r, g, b};
  return image;
}

// Inverse of the sRGB transfer function, from IEC 61966-2-1.
double decodeSrgb(double v) {
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

double linearOf(float r, float g, float b, int channel, const ToneMapping& mapping = {}) {
  return decodeSrgb(
      static_cast<double>(toneMap(onePixel(r, g, b), mapping).values[static_cast<size_t>(channel)]));
}

TEST(ToneMap, KnownGreys) {
  EXPECT_EQ(toneMap(onePixel(0, 0, 0)).values[0], 0.f);
  // Below 0.08 the offset is x - x^2 / 0.16 (6.25 x^2), so x becomes 6.25 x^2.
  EXPECT_NEAR(linearOf(0.02f, 0.02f, 0.02f, 0), 6.25 * 0.02 * 0.02, 1e-6);
  // From 0.08 up to 0.8 it is 0.04.
  EXPECT_NEAR(linearOf(0.08f, 0.08f, 0.08f, 0), 0.04, 1e-6);
  EXPECT_NEAR(linearOf(0.5f, 0.5f, 0.5f, 1), 0.46, 1e-6);
  EXPECT_NEAR(linearOf(0.8f, 0.8f, 0.8f, 2), 0.76, 1e-6);
  // Above: 1 - 0.24^2 / (peak + 0.24 - 0.76), grey stays grey. Peak 2 - 0.04 = 1.96.
  EXPECT_NEAR(linearOf(2, 2, 2, 0), 1 - 0.0576 / 1.44, 1e-6);
}

TEST(ToneMap, SaturatedBrightColourMovesToWhite) {
  // Red 4: no offset (smallest is 0); new peak 1 - 0.0576 / 3.48; mixed with white by 1 - 1 / (0.15 * d + 1).
  const double newPeak = 1 - 0.0576 / (4 + 0.24 - 0.76);
  const double white = 1 - 1 / (0.15 * (4 - newPeak) + 1);
  EXPECT_NEAR(linearOf(4, 0, 0, 0), newPeak, 1e-5);
  EXPECT_NEAR(linearOf(4, 0, 0, 1), white * newPeak, 1e-5);
}

TEST(ToneMap, KeepsHueBelowTheShoulder) {
  // 0.08 is the smallest, so 0.04 goes off each channel and nothing else happens.
  EXPECT_NEAR(linearOf(0.6f, 0.3f, 0.08f, 0), 0.56, 1e-6);
  EXPECT_NEAR(linearOf(0.6f, 0.3f, 0.08f, 1), 0.26, 1e-6);
  EXPECT_NEAR(linearOf(0.6f, 0.3f, 0.08f, 2), 0.04, 1e-6);
}

TEST(ToneMap, RisesAndStaysInRange) {
  float last = -1;
  for (float v = 0; v < 1e6f; v = v * 1.1f + 1e-4f) {
    const float mapped = toneMap(onePixel(v, v, v)).values[0];
    EXPECT_GE(mapped, last);
    EXPECT_LE(mapped, 1.f);
    last = mapped;
  }
}

TEST(ToneMap, NanIsBlackInfinityWhiteNegativeBlack) {
  const float inf = std::numeric_limits<float>::infinity();
  const float big = std::numeric_limits<float>::max();
  for (float bright : {inf, big})
    for (float value : toneMap(onePixel(bright, bright, bright)).values) EXPECT_NEAR(value, 1.f, 1e-6f);
  for (float value : toneMap(onePixel(std::nanf(""), -1.f, -inf)).values) EXPECT_EQ(value, 0.f);
  for (float value : toneMap(onePixel(inf, 0, std::nanf(""))).values) {
    EXPECT_GE(value, 0.f);
    EXPECT_LE(value, 1.f);
  }
}

TEST(ToneMap, FurtherChannelsAreKept) {
  Image image(2, 1, 5);
  image.values = {0.1f, 0.2f, 0.3f, 7.f, -3.f, 0.3f, 0.2f, 0.1f, 0.25f, 9.f};
  const Image mapped = toneMap(image);
  EXPECT_EQ(mapped.channels, 5);
  EXPECT_EQ(mapped.values[3], 7.f);
  EXPECT_EQ(mapped.values[4], -3.f);
  EXPECT_EQ(mapped.values[8], 0.25f);
  EXPECT_EQ(mapped.values[9], 9.f);
  EXPECT_NE(mapped.values[5], image.values[5]);
}

TEST(ToneMap, NeutralScalesBeforeTheCurve) {
  EXPECT_NEAR(linearOf(0.25f, 0.25f, 0.25f, 0, {.scale = 2}), 0.46, 1e-6);
}

// ---- Reinhard --------------------------------------------------------------------------------------------

Image row(const std::vector<float>& greys) {
  Image image(static_cast<int>(greys.size()), 1, 3);
  for (size_t i = 0; i < greys.size(); ++i) std::fill_n(&image.values[3 * i], 3, greys[i]);
  return image;
}

TEST(ToneMap, NamesOfCurves) {
  EXPECT_EQ(toneCurves().named("neutral"), ToneCurve::Neutral);
  EXPECT_EQ(toneCurves().named("reinhard"), ToneCurve::Reinhard);
  EXPECT_ANY_THROW(toneCurves().named("filmic"));
}

TEST(Brightness, IsTheGeometricMean) {
  const Brightness brightness = brightnessOf(row({1, 4, 16}));
  EXPECT_NEAR(brightness.logAverage, 4, 1e-12);
  EXPECT_NEAR(brightness.largest, 16, 1e-12);
  Image red(1, 1, 3);
  red.values = {2, 0, 0};
  EXPECT_NEAR(brightnessOf(red).logAverage, 0.4252, 1e-12);
}

TEST(Brightness, WhatIsBlackOrNoNumberDoesNotCount) {
  const float inf = std::numeric_limits<float>::infinity();
  const Brightness brightness = brightnessOf(row({0, 2, 0, std::nanf(""), 8, inf, -inf, 0, 1e-5f, 0}));
  EXPECT_NEAR(brightness.logAverage, 4, 1e-6);
  EXPECT_NEAR(brightness.largest, 8, 1e-6);
  // A dim picture counts as a bright one does.
  EXPECT_NEAR(brightnessOf(row({1e-20f, 4e-20f})).logAverage, 2e-20, 1e-25);
}

TEST(Brightness, OfNothingIsNothing) {
  for (const std::vector<float>& greys :
       {std::vector<float>{0, 0}, {-1}, {std::nanf("")}, {std::numeric_limits<float>::infinity()}, {}}) {
    const Brightness brightness = brightnessOf(row(greys));
    EXPECT_EQ(brightness.logAverage, 0);
    EXPECT_EQ(brightness.largest, 0);
    EXPECT_EQ(toneMap(row({0, 0}), reinhard(brightness)).values, std::vector<float>(6, 0.f));
  }
}

TEST(Brightness, IsTheSameWhateverTheThreads) {
  base::Random random(3);
  Image image(67, 301, 3);
  for (float& value : image.values) value = static_cast<float>(random.uniform());
  const Brightness all = brightnessOf(image);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(brightnessOf(image).logAverage, all.logAverage);
}

TEST(Reinhard, AConstantImageIsMiddleGrey) {
  for (const float grey : {1e-6f, 0.18f, 1.f, 5000.f}) {
    const Image image = row({grey, grey, grey});
    const ToneMapping mapping = reinhard(brightnessOf(image));
    EXPECT_NEAR(linearOf(grey, grey, grey, 0, mapping), 0.18, 1e-6);
    // Two stops more are four times that; white is then still where the curve is straight.
    EXPECT_NEAR(linearOf(grey, grey, grey, 1, reinhard(brightnessOf(image), 2)), 0.72, 1e-6);
  }
}

TEST(Reinhard, TheWhitePointIsWhite) {
  const Brightness brightness = brightnessOf(row({0.5, 2, 8, 700}));
  const ToneMapping ofLargest = reinhard(brightness), ofFour = reinhard(brightness, 0, 4);
  EXPECT_NEAR(linearOf(700, 700, 700, 0, ofLargest), 1, 1e-6);
  EXPECT_LT(linearOf(600, 600, 600, 0, ofLargest), 0.999);
  EXPECT_NEAR(linearOf(4, 4, 4, 0, ofFour), 1, 1e-6);
  EXPECT_LT(linearOf(3.5f, 3.5f, 3.5f, 0, ofFour), 0.999);
  EXPECT_NEAR(linearOf(5, 5, 5, 0, ofFour), 1, 1e-6);
  EXPECT_NEAR(linearOf(4, 4, 4, 0, reinhard(brightness, 3, 4)), 1, 1e-6) << "whatever the exposure";
}

TEST(Reinhard, FollowsItsEquation) {
  base::Random random(5);
  Image image(9, 7, 3);
  for (float& value : image.values) value = 50 * static_cast<float>(std::pow(random.uniform(), 4));
  const ToneMapping mapping = reinhard(brightnessOf(image));
  double sum = 0, largest = 0;
  const auto luminance = [](const double* c) { return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; };
  for (int i = 0; i < 63; ++i) {
    const double rgb[] = {image.values[3 * i], image.values[3 * i + 1], image.values[3 * i + 2]};
    sum += std::log(luminance(rgb));
    largest = std::max(largest, luminance(rgb));
  }
  const double scale = 0.18 / std::exp(sum / 63), white = scale * largest;
  ASSERT_GT(white, 1);
  const Image mapped = toneMap(image, mapping);
  for (int i = 0; i < 63; ++i) {
    double rgb[3];
    for (int c = 0; c < 3; ++c) rgb[c] = scale * image.values[3 * i + c];
    const double before = luminance(rgb), after = before * (1 + before / (white * white)) / (1 + before);
    double shown[3];
    for (int c = 0; c < 3; ++c) shown[c] = decodeSrgb(mapped.values[3 * i + c]);
    EXPECT_NEAR(luminance(shown), after, 2e-6);
    // Colours keep their ratios, or are at the edge of what a screen shows.
    const bool atEdge = std::max({shown[0], shown[1], shown[2]}) > 1 - 1e-6;
    for (int c = 0; c < 3 && !atEdge; ++c) EXPECT_NEAR(shown[c], rgb[c] * after / before, 2e-6);
  }
}

TEST(Reinhard, ASaturatedColourKeepsItsLuminanceAndHue) {
  // Luminance 0.2126 * 30, of which 6.378 / 7.378 is shown: too much for a red, so green and blue rise
  // together.
  const double r = linearOf(30, 0, 0, 0, {.curve = ToneCurve::Reinhard});
  const double g = linearOf(30, 0, 0, 1, {.curve = ToneCurve::Reinhard});
  const double b = linearOf(30, 0, 0, 2, {.curve = ToneCurve::Reinhard});
  EXPECT_NEAR(r, 1, 1e-6);
  EXPECT_NEAR(g, b, 1e-6);
  EXPECT_NEAR(0.2126 * r + 0.7152 * g + 0.0722 * b, 6.378 / 7.378, 1e-5);
}

TEST(Reinhard, NanIsBlackInfinityWhiteNegativeBlack) {
  const float inf = std::numeric_limits<float>::infinity();
  const ToneMapping mapping = reinhard(brightnessOf(row({0.1f, 3})));
  for (float value : toneMap(onePixel(inf, inf, inf), mapping).values) EXPECT_NEAR(value, 1.f, 1e-6f);
  for (float value : toneMap(onePixel(std::nanf(""), -1.f, -inf), mapping).values) EXPECT_EQ(value, 0.f);
}

}  // namespace
}  // namespace sfumato::image
