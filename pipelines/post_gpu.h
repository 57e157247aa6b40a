// Post-processing on the GPU.
#pragma once

#include "gl/device.h"
#include "image/image.h"
#include "pipelines/aovs.h"
#include "pipelines/post.h"

namespace sfumato::pipelines {

struct PostInputs {
  const image::Image& radiance;  // linear RGB
  const AovImages& aovs;         // those of aovsFor(), of the same size
  double white = 1;              // luminance that the screen shows as about 1
  double average = 0;            // the log-average luminance: what mipmap bloom takes off
};

// The radiance that is shown, before the tone curve: with bloom added, then anti-aliased. In 32-bit floats;
// what is negative or NaN becomes 0, and more than 65504 (the largest half) becomes that. A pixel that no
// glow and no edge touches is not changed. Costs 16 bytes a pixel, 32 more for edges and 6 more for mipmap
// bloom, beside 28 on the host. Throws Memory where a side is over the device's limit.
image::Image postProcess(gl::Device& device, const PostInputs& inputs, const PostOptions& options);

}  // namespace sfumato::pipelines
