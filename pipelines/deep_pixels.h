// From what rays meet, and from the knots of a shadow map, to the samples of deep pixels.
#pragma once

#include <span>
#include <vector>

#include "image/deep_image.h"
#include "shaders/shared/deep.h"
#include "shaders/shared/deepshadow.h"

namespace sfumato::pipelines {

// Most that compositing something at a depth inside a sample may be off by: of its own radiance, and of the
// pixel's.
constexpr double deepError = 1.0 / 512;

// What one ray of a pixel met, in order of depth.
using RayEvents = std::vector<shared::DeepEvent>;

// The mean of a pixel's rays, of which there is at least one: at each depth the radiance that is added before
// it and the light from behind that passes. A surface is a sample, and so are as many steps of smoke between
// two surfaces as keep both within `error` (see deepError); at the samples' ends, and so
// flattened, both are exact.
std::vector<image::DeepSample> joinRays(std::span<const RayEvents> rays, double error = deepError);

// A shadow map's texel: black samples that take what the light loses. `knots` are the texel's.
std::vector<image::DeepSample> samplesOf(std::span<const shared::ShadowKnot> knots, float opaqueDepth);

}  // namespace sfumato::pipelines
