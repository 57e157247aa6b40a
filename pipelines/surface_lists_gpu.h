// The translucent surfaces that the camera sees: exact lists, one a pixel, sorted by depth.
#pragma once

#include <optional>

#include "gl/buffer.h"
#include "gl/device.h"
#include "lists/lists_gpu.h"
#include "pipelines/gbuffer_gpu.h"
#include "pipelines/geometry_gpu.h"

namespace sfumato::pipelines {

struct SurfaceListInputs {
  const GeometryGpu& geometry;
  const gl::Buffer& view;  // shared::ViewParams
  const GBuffer& gbuffer;  // of the same view and size: what is behind all its samples is not stored
  int width = 0;           // of the image, pixels
  int height = 0;
  std::optional<Tile> window;  // pixels of the G-buffer that get lists, as in the view; none: all of them
  lists::ListOptions lists{};
};

// Payloads are shared::PackedSurface.
struct SurfaceLists {
  lists::Lists lists;
  lists::ListStatistics statistics;
};

// Costs 8 bytes a pixel and 48 a fragment, more while some strategies build (lists/lists_gpu.h). Throws
// Memory when they do not fit budget or device.
SurfaceLists buildSurfaceLists(gl::Device& device, const SurfaceListInputs& inputs);
// The same, but nothing where the fragments do not fit: the caller can try a smaller window.
std::optional<SurfaceLists> tryBuildSurfaceLists(gl::Device& device, const SurfaceListInputs& inputs);

}  // namespace sfumato::pipelines
