#include "image/metrics.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace sfumato::image {

using base::ExitCode;
using base::fail;

void checkComparable(const Image& image, const Image& reference) {
  if (image.width != reference.width || image.height != reference.height)
    fail(ExitCode::Usage, "images of {} x {} and {} x {} pixels: cannot be compared: give two of one size",
         image.width, image.height, reference.width, reference.height);
  if (image.values.empty() || reference.values.empty())
    fail(ExitCode::Usage, "images without pixels: cannot be compared: give some that have them");
}

Image averageDown(const Image& image, int factor) {
  if (factor < 1 || image.width % factor != 0 || image.height % factor != 0)
    fail(ExitCode::Usage, "image of {} x {} pixels: cannot be averaged by {}: choose a factor of both sides",
         image.width, image.height, factor);
  Image small(image.width / factor, image.height / factor, image.channels);
  const double weight = 1. / (static_cast<double>(factor) * factor);
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x)
      for (int c = 0; c < image.channels; ++c) {
        double sum = 0;
        for (int v = 0; v < factor; ++v)
          for (int u = 0; u < factor; ++u) sum += image.pixel(x * factor + u, y * factor + v)[c];
        small.pixel(x, y)[c] = static_cast<float>(sum * weight);
      }
  return small;
}

Difference compare(const Image& image, const Image& reference) {
  checkComparable(image, reference);
  const int channels = std::min(image.channels, reference.channels);
  double sum = 0, referenceSum = 0, squares = 0, largest = 1;
  Difference result;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < channels; ++c) {
        const double value = image.pixel(x, y)[c];
        const double expected = reference.pixel(x, y)[c];
        const double difference = std::abs(value - expected);
        sum += value;
        referenceSum += expected;
        squares += difference * difference;
        largest = std::max({largest, value, expected});
        if (difference > result.maximum || (std::isnan(difference) && !std::isnan(result.maximum))) {
          result.maximum = difference;
          result.maximumAt = {x, y, c};
        }
      }

  const double count = static_cast<double>(image.width) * image.height * channels;
  const double mean = sum / count, referenceMean = referenceSum / count;
  result.rmse = std::sqrt(squares / count);
  result.psnr = 20 * std::log10(largest / result.rmse);
  // Two black images are equal; anything against black is infinitely far.
  const auto ratio = [](double a, double b, double both) { return a == 0 && b == 0 ? both : a / b; };
  result.relativeRmse = ratio(result.rmse, referenceMean, 0);
  result.meanRatio = ratio(mean, referenceMean, 1);
  return result;
}

size_t pixelsBeyond(const Image& image, const Image& reference, double threshold) {
  checkComparable(image, reference);
  const int channels = std::min(image.channels, reference.channels);
  size_t count = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const float* a = image.pixel(x, y);
      const float* b = reference.pixel(x, y);
      const auto isClose = [&](float left, float right) {
        return std::abs(static_cast<double>(left) - right) <= threshold;
      };
      count += std::equal(a, a + channels, b, isClose) ? 0 : 1;
    }
  return count;
}

NotFinite findNotFinite(const Image& image) {
  NotFinite result;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < image.channels; ++c) {
        const float value = image.pixel(x, y)[c];
        if (std::isfinite(value)) continue;
        if (result.count++ == 0) {
          result.first = {x, y, c};
          result.value = value;
        }
      }
  return result;
}

}  // namespace sfumato::image
