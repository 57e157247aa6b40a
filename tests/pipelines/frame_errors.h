// How a frame of the GPU is held against the reference.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <numeric>
#include <string>

#include "image/image_file.h"
#include "image/metrics.h"
#include "pipelines/quality.h"

namespace sfumato::pipelines {

// Fine enough that what is left are the pixels at edges of shadows, where the map's texels show.
inline const Quality fine{.samples = 1,
                          .shadowResolution = 1024,
                          .stepVoxels = 0.5,
                          .shadowError = 1.0 / 4096,
                          .throughputCutoff = 1e-6,
                          .smokeShadows = ShadowFilter::Bilinear};

// With SFUMATO_TEST_OUTPUT: the pictures, to be looked at.
inline void keep(const std::string& name, const image::Image& image) {
  if (const char* folder = std::getenv("SFUMATO_TEST_OUTPUT"))
    image::writeImage(std::string(folder) + "/" + name + ".exr", image, {});
}

struct PixelErrors {
  double failingFraction = 0;  // of pixels off by more than 2 % of the mean plus 2 % of themselves
  double mean = 0;             // of the reference
  double meanRatio = 0;
  double relativeRmse = 0;
};

inline PixelErrors errors(const image::Image& image, const image::Image& reference) {
  const image::Difference difference = image::compare(image, reference);
  const auto values = static_cast<double>(reference.values.size());
  const double mean = std::accumulate(reference.values.begin(), reference.values.end(), 0.0) / values;
  size_t failing = 0;
  for (size_t i = 0; i < image.values.size(); ++i) {
    const double off = std::abs(double(image.values[i]) - double(reference.values[i]));
    if (!(off <= 0.02 * (mean + std::abs(double(reference.values[i]))))) ++failing;
  }
  return {static_cast<double>(failing) / values, mean, difference.meanRatio, difference.relativeRmse};
}

// Keeps both pictures of the scene `name`, and prints how far they are apart.
inline PixelErrors compareFrames(const std::string& name, const image::Image& image,
                                 const image::Image& reference) {
  keep(name, image);
  keep(name + "_reference", reference);
  const PixelErrors found = errors(image, reference);
  fmt::print("{}: failing {:.4f}, mean ratio {:.5f}, relative RMSE {:.4f}\n", name, found.failingFraction,
             found.meanRatio, found.relativeRmse);
  return found;
}

}  // namespace sfumato::pipelines
