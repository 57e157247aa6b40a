// How far two images are apart.
#pragma once

#include "image/image.h"

namespace sfumato::image {

// Averages blocks of factor x factor pixels. Throws Usage unless both sides of the image are multiples of it.
Image averageDown(const Image& image, int factor);

// Where in an image: pixels from the left and from the top, and a channel.
struct Place {
  int x = 0;
  int y = 0;
  int channel = 0;
};

// Throws Usage unless the images have one size, and pixels.
void checkComparable(const Image& image, const Image& reference);

struct Difference {
  double rmse = 0;          // over all pixels and channels
  double relativeRmse = 0;  // rmse / mean of the reference
  double psnr = 0;     // dB: of the largest value of either, at least 1, over rmse; infinite for equal images
  double maximum = 0;  // largest absolute difference
  Place maximumAt;     // the first of that difference
  double meanRatio = 0;  // mean of the image / mean of the reference
};

// Over the channels that both have. Throws as checkComparable(). A NaN in either makes the figures NaN.
Difference compare(const Image& image, const Image& reference);

// Pixels of which a channel that both have differs by more than `threshold`, or by NaN. Throws as
// checkComparable().
size_t pixelsBeyond(const Image& image, const Image& reference, double threshold);

// The values of an image that are NaN or infinite.
struct NotFinite {
  size_t count = 0;
  Place first;
  float value = 0;  // the first one
};
NotFinite findNotFinite(const Image& image);

}  // namespace sfumato::image
