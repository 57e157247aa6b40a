// The curves: "Khronos PBR Neutral Tone Mapper" (Khronos 2024); Reinhard et al. 2002, equations 1, 2 and 4.
// The transfer function: IEC 61966-2-1.
#include "image/tone_map.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"

namespace sfumato::image {
namespace {

constexpr float f90 = 0.04f;  // what a dielectric reflects at normal incidence
constexpr float startCompression = 0.8f - f90;
constexpr float desaturation = 0.15f;
constexpr float brightest = 1e30f;  // stands for infinity: its squares stay within reach of the curve

float usable(float value) {
  return std::isnan(value) ? 0.f : std::clamp(value, 0.f, brightest);
}

double luminance(const float rgb[3]) {
  return 0.2126 * static_cast<double>(rgb[0]) + 0.7152 * static_cast<double>(rgb[1]) +
         0.0722 * static_cast<double>(rgb[2]);
}

void compressNeutral(float rgb[3]) {
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

void compressReinhard(float rgb[3], double white) {
  const double before = luminance(rgb);
  if (before <= 0) return;
  const double after = std::min(before * (1 + before / white / white) / (1 + before), 1.);
  const auto dim = static_cast<float>(after / before);
  for (int c = 0; c < 3; ++c) rgb[c] *= dim;

  const auto grey = static_cast<float>(after);
  const float peak = std::max({rgb[0], rgb[1], rgb[2]});
  if (peak <= 1.f) return;
  const float saturation = (1.f - grey) / (peak - grey);
  for (int c = 0; c < 3; ++c) rgb[c] = std::lerp(grey, rgb[c], saturation);
}

float encodeSrgb(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.f / 2.4f) - 0.055f;
}

struct Sums {
  size_t count = 0;  // of pixels
  double sum = 0;
  double largest = 0;
};

// Of what `value` makes of each finite luminance that is not below `least`. Rows are added in their order,
// whoever did them.
Sums sumUp(const Image& image, double least, double (*value)(double)) {
  std::vector<Sums> rows(static_cast<size_t>(image.height));
  base::parallelFor(image.height, [&](long y) {
    Sums& row = rows[static_cast<size_t>(y)];
    for (int x = 0; x < image.width; ++x) {
      float rgb[3];
      std::copy_n(image.pixel(x, static_cast<int>(y)), 3, rgb);
      if (!std::all_of(rgb, rgb + 3, [](float v) { return std::isfinite(v); })) continue;
      std::transform(rgb, rgb + 3, rgb, usable);
      const double luminanceHere = luminance(rgb);
      if (luminanceHere < least) continue;
      ++row.count;
      row.sum += value(luminanceHere);
      row.largest = std::max(row.largest, luminanceHere);
    }
  });
  Sums all;
  for (const Sums& row : rows)
    all = {all.count + row.count, all.sum + row.sum, std::max(all.largest, row.largest)};
  return all;
}

constexpr double negligible = 1e-4;  // part of the mean luminance

}  // namespace

const base::Choice<ToneCurve>& toneCurves() {
  static const base::Choice<ToneCurve> choice{"--tonemap", {"neutral", "reinhard"}};
  return choice;
}

Brightness brightnessOf(const Image& linear) {
  base::check(linear.channels >= 3, "an image to measure has red, green and blue");
  const Sums all = sumUp(linear, 0, [](double luminance) { return luminance; });
  if (all.sum <= 0) return {};
  const double mean = all.sum / static_cast<double>(all.count);
  const Sums lit = sumUp(linear, negligible * mean, [](double luminance) { return std::log(luminance); });
  return {std::exp(lit.sum / static_cast<double>(lit.count)), all.largest};
}

ToneMapping reinhard(const Brightness& brightness, double stops, std::optional<double> white) {
  if (brightness.logAverage <= 0) return {.curve = ToneCurve::Reinhard};
  const double scale = middleGrey * std::exp2(stops) / brightness.logAverage;
  return {ToneCurve::Reinhard, scale, white ? scale * *white : std::max(scale * brightness.largest, 1.)};
}

Image toneMap(const Image& linear, const ToneMapping& mapping) {
  base::check(linear.channels >= 3, "an image to tone-map has red, green and blue");
  const auto scale = static_cast<float>(mapping.scale);
  Image screen = linear;
  for (size_t i = 0; i < screen.values.size(); i += static_cast<size_t>(screen.channels)) {
    float* rgb = &screen.values[i];
    std::transform(rgb, rgb + 3, rgb, [&](float value) { return usable(value * scale); });
    if (mapping.curve == ToneCurve::Neutral)
      compressNeutral(rgb);
    else
      compressReinhard(rgb, mapping.white);
    std::transform(rgb, rgb + 3, rgb, [](float value) { return encodeSrgb(std::clamp(value, 0.f, 1.f)); });
  }
  return screen;
}

}  // namespace sfumato::image
