// Deep images of what the camera sees and of what a light's shadow map holds.
#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "deepshadow/maps_gpu.h"
#include "gl/device.h"
#include "image/deep_image.h"
#include "pipelines/split_rays.h"
#include "pipelines/tiles.h"
#include "shaders/shared/view.h"

namespace sfumato::pipelines {

// Only tests ask for less.
struct DeepLimits {
  size_t sampleBytes = std::numeric_limits<size_t>::max();  // of a deep image
  size_t eventBytes = size_t{64} << 20;                     // of what the rays that are walked at a time meet
};

// The same, with no more for samples than half of the memory that is free.
DeepLimits withinMemory(DeepLimits limits);

// The rays of a window's pixels.
struct DeepRays {
  Tile window;
  const SplitRays& ofPixels;
  std::function<void(size_t rays)> walk;  // walks so many rays, which are bound with room for their events
};

// Walks the rays of a window, many at a time, and joins those of each pixel in `image`, whose rows count from
// the top. Nothing is lost: rays whose events find no room are walked again, fewer at a time. Throws Memory
// where a single pixel's events are over the device's limit, or the image is over its own.
void recordDeep(gl::Device& device, const DeepRays& rays, const DeepLimits& limits, image::DeepImage& image);

// What a deep image of the camera is looked at from.
image::DeepView deepView(const shared::ViewParams& view);

// Faces of a light's map, one image each; those of a cube are named +x, -x, +y, -y, +z and -z. Throws Memory
// where they are over their limit.
std::vector<image::DeepImage> deepShadow(const deepshadow::Maps& maps, size_t light,
                                         const DeepLimits& limits);

}  // namespace sfumato::pipelines
