// How far two images are apart.
#pragma once

#include "image/image.h"

namespace sfumato::image {

// Averages blocks of factor x factor pixels. Throws Usage unless both sides of the image are multiples of it.
Image averageDown(const Image& image, int factor);

struct Difference {
  double rmse = 0;          // over all pixels and channels
  double relativeRmse = 0;  // rmse / mean of the reference
  double maximum = 0;       // largest absolute difference
  double meanRatio = 0;     // mean of the image / mean of the reference
};

// Over the channels that both have. Throws Usage when the sizes differ. A NaN in either makes the figures
// NaN.
Difference compare(const Image& image, const Image& reference);

}  // namespace sfumato::image
