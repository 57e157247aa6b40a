#include "image/tone_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

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

double linearOf(float r, float g, float b, int channel) {
  return decodeSrgb(static_cast<double>(toneMap(onePixel(r, g, b)).values[static_cast<size_t>(channel)]));
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

}  // namespace
}  // namespace sfumato::image
