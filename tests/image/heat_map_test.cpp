#include "image/heat_map.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"

namespace sfumato::image {
namespace {

double linear(uint8_t byte) {
  const double v = byte / 255.0;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

// CIE 1976 L*, another measure of lightness than the one that the colours are made with.
double lightness(const std::array<uint8_t, 3>& rgb) {
  const double y = 0.2126 * linear(rgb[0]) + 0.7152 * linear(rgb[1]) + 0.0722 * linear(rgb[2]);
  return y > 0.008856 ? 116 * std::cbrt(y) - 16 : 903.3 * y;
}

TEST(HeatColour, RunsFromBlackToNearlyWhiteInEqualSteps) {
  EXPECT_LT(lightness(heatColour(0)), 5);
  EXPECT_GT(lightness(heatColour(1)), 93);
  constexpr int steps = 32;
  for (int i = 0; i < steps; ++i) {
    const double rise = lightness(heatColour((i + 1.0) / steps)) - lightness(heatColour(double(i) / steps));
    EXPECT_GT(rise, 0.3 * 95 / steps) << i;
    EXPECT_LT(rise, 2.0 * 95 / steps) << i;
  }
}

TEST(HeatColour, HasColourBetween) {
  for (double t = 0.2; t < 0.9; t += 0.05) {
    const auto rgb = heatColour(t);
    EXPECT_GT(std::max({rgb[0], rgb[1], rgb[2]}) - std::min({rgb[0], rgb[1], rgb[2]}), 60) << t;
  }
}

TEST(HeatColour, IsClampedAndShowsNan) {
  EXPECT_EQ(heatColour(-1), heatColour(0));
  EXPECT_EQ(heatColour(INFINITY), heatColour(1));
  EXPECT_EQ(heatColour(NAN), (std::array<uint8_t, 3>{255, 255, 255}));
}

std::array<uint8_t, 3> at(const Picture& picture, size_t pixel) {
  return {picture.rgba[pixel * 4], picture.rgba[pixel * 4 + 1], picture.rgba[pixel * 4 + 2]};
}

TEST(HeatMap, ShowsTheLargestDifferenceOfAPixel) {
  Image image(3, 1, 3);
  image.values = {0, 0, 0, 1, -2, 0.5f, 1, 1, NAN};
  const Picture picture = heatMap(image, Image(3, 1, 3), 4);
  ASSERT_EQ(picture.rgba.size(), 12u);
  EXPECT_EQ(at(picture, 0), heatColour(0));
  EXPECT_EQ(at(picture, 1), heatColour(0.5));
  EXPECT_EQ(at(picture, 2), heatColour(NAN));
  for (size_t i = 3; i < 12; i += 4) EXPECT_EQ(picture.rgba[i], 255);
}

TEST(HeatMap, ShowsTheFirstChannelOfValues) {
  Image counts(2, 2, 1);
  counts.values = {0, 3, 6, 12};
  const Picture picture = heatMap(counts, 6);
  EXPECT_EQ(at(picture, 0), heatColour(0));
  EXPECT_EQ(at(picture, 1), heatColour(0.5));
  EXPECT_EQ(at(picture, 2), heatColour(1));
  EXPECT_EQ(at(picture, 3), heatColour(1));
  EXPECT_EQ(at(heatMap(Image(1, 1, 1), 0), 0), heatColour(0));
}

TEST(HeatMap, OfEqualImagesIsBlack) {
  const Picture picture = heatMap(Image(2, 2, 3), Image(2, 2, 3), 0);
  for (size_t i = 0; i < 4; ++i) EXPECT_EQ(at(picture, i), heatColour(0));
}

TEST(HeatMap, RefusesOtherSizes) {
  EXPECT_THROW(heatMap(Image(2, 1, 3), Image(1, 2, 3), 1), base::Error);
}

}  // namespace
}  // namespace sfumato::image
