// How deep pixels are composited, after "Interpreting OpenEXR Deep Pixels", in double precision.
#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <span>

#include "image/deep_image.h"

namespace sfumato::test {

// What is seen of a pixel, and how much of what is behind it, of R, G and B together and of each.
struct Composite {
  glm::dvec3 colour{0};
  double passed = 1;
  glm::dvec3 passedOfEach{1};
};

// The samples before a depth; those that reach beyond it up to there.
inline Composite compositeUpTo(std::span<const image::DeepSample> samples, double depth) {
  Composite sum;
  for (const image::DeepSample& sample : samples) {
    if (sample.z >= depth) continue;
    const double fraction =
        sample.zBack > depth ? (depth - sample.z) / (double(sample.zBack) - sample.z) : 1.0;
    const double alpha = 1 - std::pow(1 - double(sample.alpha), fraction);
    const double share = sample.alpha > 0 ? alpha / sample.alpha : fraction;
    for (int c = 0; c < 3; ++c) {
      const auto channel = static_cast<size_t>(c);
      sum.colour[c] += sum.passed * share * sample.colour[channel];
      sum.passedOfEach[c] *= std::pow(1 - double(sample.takes[channel]), fraction);
    }
    sum.passed *= 1 - alpha;
  }
  return sum;
}

inline Composite composite(std::span<const image::DeepSample> samples) {
  return compositeUpTo(samples, std::numeric_limits<double>::infinity());
}

}  // namespace sfumato::test
