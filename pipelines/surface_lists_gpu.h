// The translucent surfaces that the camera sees: exact lists, one a pixel, sorted by depth.
#pragma once

#include "gl/buffer.h"
#include "gl/device.h"
#include "lists/linked_lists_gpu.h"
#include "pipelines/gbuffer_gpu.h"
#include "pipelines/geometry_gpu.h"

namespace sfumato::pipelines {

struct SurfaceListInputs {
  const GeometryGpu& geometry;
  const gl::Buffer& view;  // shared::ViewParams
  const GBuffer& gbuffer;  // of the same view and size: what is behind all its samples is not stored
  int width = 0;
  int height = 0;
};

// Payloads are shared::PackedSurface.
struct SurfaceLists {
  lists::LinkedLists lists;
  lists::ListStatistics statistics;
};

// Costs 8 bytes a pixel and 52 a fragment. Throws Memory when they do not fit the device.
SurfaceLists buildSurfaceLists(gl::Device& device, const SurfaceListInputs& inputs);

}  // namespace sfumato::pipelines
