// A number for each pixel, shown as a colour.
#pragma once

#include <array>
#include <cstdint>

#include "image/image.h"
#include "image/image_file.h"

namespace sfumato::image {

// sRGB of t in [0, 1]: nearly black, violet, red, orange, pale yellow. Equal steps of t are equal steps of
// lightness in OKLab (Ottosson 2020), so that it reads in grey as well. Clamped outside; white for a NaN.
std::array<uint8_t, 3> heatColour(double t);

// The first channel of each pixel, as heatColour(value / scale).
Picture heatMap(const Image& values, double scale);

// The largest absolute difference of each pixel, over the channels that both have, as heatColour(difference /
// scale). Throws as checkComparable().
Picture heatMap(const Image& image, const Image& reference, double scale);

}  // namespace sfumato::image
