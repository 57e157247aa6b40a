// From linear radiance to a screen.
#pragma once

#include "image/image.h"

namespace sfumato::image {

// The Khronos PBR Neutral curve (Khronos 2024) on each pixel of a linear RGB image, then the sRGB transfer
// function: values in [0, 1]. Colours below 0.8 keep hue and saturation, brighter ones roll off towards
// white. Further channels are kept. NaN becomes 0, infinity white.
Image toneMap(const Image& linear);

}  // namespace sfumato::image
