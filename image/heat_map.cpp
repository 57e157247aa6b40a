// The colour space: Ottosson 2020, "A perceptual color space for image processing".
#include "image/heat_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "image/metrics.h"

namespace sfumato::image {
namespace {

constexpr double darkest = 0.16;  // lightness at the bottom: on a screen, black
constexpr double brightest = 0.97;
constexpr double radiansPerDegree = std::numbers::pi / 180;

struct OkLch {
  double lightness;
  double chroma;
  double hue;  // radians
};

std::array<double, 3> linearFrom(const OkLch& colour) {
  const double a = colour.chroma * std::cos(colour.hue);
  const double b = colour.chroma * std::sin(colour.hue);
  const auto cube = [](double x) { return x * x * x; };
  const double l = cube(colour.lightness + 0.3963377774 * a + 0.2158037573 * b);
  const double m = cube(colour.lightness - 0.1055613458 * a - 0.0638541728 * b);
  const double s = cube(colour.lightness - 0.0894841775 * a - 1.2914855480 * b);
  return {4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
          -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
          -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s};
}

bool isShown(const std::array<double, 3>& linear) {
  return std::all_of(linear.begin(), linear.end(), [](double v) { return v >= 0 && v <= 1; });
}

// The colour, or the most saturated one of its hue and lightness that a screen has.
std::array<double, 3> shown(OkLch colour) {
  double low = 0, high = colour.chroma;
  if (isShown(linearFrom(colour))) return linearFrom(colour);
  for (int i = 0; i < 24; ++i) {
    colour.chroma = (low + high) / 2;
    (isShown(linearFrom(colour)) ? low : high) = colour.chroma;
  }
  colour.chroma = low;
  return linearFrom(colour);
}

uint8_t encode(double linear) {
  const double value = std::clamp(linear, 0.0, 1.0);
  const double encoded = value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1 / 2.4) - 0.055;
  return static_cast<uint8_t>(std::lround(encoded * 255));
}

}  // namespace

std::array<uint8_t, 3> heatColour(double t) {
  if (std::isnan(t)) return {255, 255, 255};
  t = std::clamp(t, 0.0, 1.0);
  // The hue runs from violet, over red, to yellow; the chroma rises and falls with it.
  const OkLch colour{.lightness = std::lerp(darkest, brightest, t),
                     .chroma = 0.24 * std::sin(std::numbers::pi * std::pow(t, 0.6)),
                     .hue = (-70 + 175 * t) * radiansPerDegree};
  const auto linear = shown(colour);
  return {encode(linear[0]), encode(linear[1]), encode(linear[2])};
}

Picture heatMap(const Image& values, double scale) {
  Picture picture{values.width, values.height, {}};
  const size_t pixels = static_cast<size_t>(values.width) * static_cast<size_t>(values.height);
  picture.rgba.reserve(pixels * 4);
  for (size_t i = 0; i < pixels; ++i) {
    const double value = values.values[i * static_cast<size_t>(values.channels)];
    const auto colour = heatColour(value == 0 ? 0 : value / scale);
    picture.rgba.insert(picture.rgba.end(), colour.begin(), colour.end());
    picture.rgba.push_back(255);
  }
  return picture;
}

Picture heatMap(const Image& image, const Image& reference, double scale) {
  checkComparable(image, reference);
  const int channels = std::min(image.channels, reference.channels);
  Image largest(image.width, image.height, 1);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < channels; ++c) {
        const float difference = std::abs(image.pixel(x, y)[c] - reference.pixel(x, y)[c]);
        float& most = *largest.pixel(x, y);
        if (difference > most || std::isnan(difference)) most = difference;
      }
  return heatMap(largest, scale);
}

}  // namespace sfumato::image
