// From linear radiance to a screen.
#pragma once

#include <limits>
#include <optional>

#include "base/choice.h"
#include "image/image.h"

namespace sfumato::image {

// Neutral: Khronos PBR Neutral (Khronos 2024): colours below 0.8 keep hue and saturation, brighter ones roll
// off towards white. Reinhard: the global operator of Reinhard et al. 2002 ("Photographic tone reproduction
// for digital images", section 3.1), on luminance; a colour that the screen has not at its luminance moves
// towards grey.
enum class ToneCurve { Neutral, Reinhard };
const base::Choice<ToneCurve>& toneCurves();  // "neutral", "reinhard"

struct ToneMapping {
  ToneCurve curve = ToneCurve::Neutral;
  double scale = 1;                                        // of all values, before the curve
  double white = std::numeric_limits<double>::infinity();  // scaled luminance that becomes 1; Reinhard only
};

// Luminances (Rec. 709) of an image; the same whatever the number of threads.
struct Brightness {
  // exp of the mean of log; 0 where all is black. Pixels below 1e-4 of the arithmetic mean are left out: a
  // black background would else decide how bright the rest is shown.
  double logAverage = 0;
  double largest = 0;
};
// Of a linear RGB image. What is negative counts as 0; pixels with a NaN or an infinity do not count.
Brightness brightnessOf(const Image& linear);

constexpr double middleGrey = 0.18;

// Shows the log-average luminance as 0.18, times two for each stop. White is the given luminance, before
// scaling, or the largest of the image; an image without any that is scaled above 1 stays linear.
ToneMapping reinhard(const Brightness& brightness, double stops = 0, std::optional<double> white = {});

// The curve on each pixel of a linear RGB image, then the sRGB transfer function: values in [0, 1]. Further
// channels are kept. NaN becomes 0, infinity white.
Image toneMap(const Image& linear, const ToneMapping& mapping = {});

}  // namespace sfumato::image
