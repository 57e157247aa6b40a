// The curve: "Khronos PBR Neutral Tone Mapper" (Khronos 2024); the transfer function: IEC 61966-2-1.
#include "image/tone_map.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace sfumato::image {
namespace {

constexpr float f90 = 0.04f;  // what a dielectric reflects at normal incidence
constexpr float startCompression = 0.8f - f90;
constexpr float desaturation = 0.15f;
constexpr float brightest = 1e30f;  // stands for infinity: its squares stay within reach of the curve

float usable(float value) {
  return std::isnan(value) ? 0.f : std::clamp(value, 0.f, brightest);
}

void compress(float rgb[3]) {
  const float smallest = std::min({rgb[0], rgb[1], rgb[2]});
  const float offset = smallest < 2.f * f90 ? smallest - smallest * smallest / (4.f * f90) : f90;
  for (int c = 0; c < 3; ++c) rgb[c] -= offset;

  const float peak = std::max({rgb[0], rgb[1], rgb[2]});
  if (peak < startCompression) return;
  const float headroom = 1.f - startCompression;
  const float newPeak = 1.f - headroom * headroom / (peak + headroom - startCompression);
  const float white = 1.f - 1.f / (desaturation * (peak - newPeak) + 1.f);
  for (int c = 0; c < 3; ++c) rgb[c] = std::lerp(rgb[c] * (newPeak / peak), newPeak, white);
}

float encodeSrgb(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.f / 2.4f) - 0.055f;
}

}  // namespace

Image toneMap(const Image& linear) {
  base::check(linear.channels >= 3, "an image to tone-map has red, green and blue");
  Image screen = linear;
  for (size_t i = 0; i < screen.values.size(); i += static_cast<size_t>(screen.channels)) {
    float* rgb = &screen.values[i];
    std::transform(rgb, rgb + 3, rgb, usable);
    compress(rgb);
    std::transform(rgb, rgb + 3, rgb, [](float value) { return encodeSrgb(std::clamp(value, 0.f, 1.f)); });
  }
  return screen;
}

}  // namespace sfumato::image
