// Which pixels of a window are walked sample by sample: those whose samples differ.
#pragma once

#include "gl/buffer.h"
#include "lists/lists_gpu.h"
#include "pipelines/gbuffer_gpu.h"
#include "pipelines/tiles.h"

namespace sfumato::pipelines {

// See shaders/shared/resolve.h.
struct Split {
  gl::Buffer groups;  // pixelGroups
  size_t count = 0;   // of groups
};

// Of a window of the image.
struct SplitInputs {
  const gl::Buffer& view;
  const GBuffer& gbuffer;
  const lists::Lists& surfaces;
  Tile window;
};

// 4 bytes a pixel and a group; nothing where pixels have one sample.
Split splitPixels(gl::Device& device, const SplitInputs& inputs);

// What the camera's rays meet, for shaders that go through it: the view, the lists and the G-buffer.
void bindSurfaces(const gl::Buffer& view, const GBuffer& gbuffer, const lists::Lists& surfaces);

}  // namespace sfumato::pipelines
