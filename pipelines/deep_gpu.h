// Deep images of what the camera sees and of what a light's shadow map holds.
#pragma once

#include <functional>
#include <vector>

#include "deepshadow/maps_gpu.h"
#include "gl/device.h"
#include "image/deep_image.h"
#include "pipelines/tiles.h"
#include "shaders/shared/view.h"

namespace sfumato::pipelines {

// The rays of a window's pixels: see shaders/shared/resolve.h.
struct DeepRays {
  Tile window;
  std::vector<uint32_t> groups;           // pixelGroups of the window's pixels
  size_t further = 0;                     // rays of a split pixel beside its first one
  std::function<void(size_t rays)> walk;  // walks so many rays, which are bound with room for their events
};

// Walks the rays of a window, many at a time, and joins those of each pixel in `image`, whose rows count from
// the top. Nothing is lost: rays whose events find no room are walked again, fewer at a time. Costs 64 MiB
// for events. Throws Memory where a single pixel's events are over the device's limit, or the image's samples
// over `mostBytes`.
void recordDeep(gl::Device& device, const DeepRays& rays, size_t mostBytes, image::DeepImage& image);

// What a deep image of the camera is looked at from.
image::DeepView deepView(const shared::ViewParams& view);

// Faces of a light's map, one image each; those of a cube are named +x, -x, +y, -y, +z and -z. Throws Memory
// when the samples are over `mostBytes`.
std::vector<image::DeepImage> deepShadow(const deepshadow::Maps& maps, size_t light, size_t mostBytes);

// Half of the memory that this machine has left.
size_t mostDeepBytes();

}  // namespace sfumato::pipelines
