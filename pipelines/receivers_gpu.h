// Between which depths something that is seen can be lit, for each cell of the light lists: lights that are
// wholly behind or before all of it need no node there.
#pragma once

#include "gl/buffer.h"
#include "gl/device.h"
#include "lists/lists_gpu.h"
#include "pipelines/gbuffer_gpu.h"
#include "pipelines/tiles.h"
#include "volumes/volumes_gpu.h"

namespace sfumato::pipelines {

struct ReceiverInputs {
  const gl::Buffer& view;  // shared::ViewParams of the window
  const GBuffer& gbuffer;
  const lists::Lists& surfaces;   // of the window
  const gl::Buffer& pixelGroups;  // of the window: which pixels are walked sample by sample (resolve.h)
  const volumes::VolumesGpu& volumes;
  int width = 0;  // of the image, pixels
  int height = 0;
  Tile window;
};

// Two floats a cell of the window, as lights::LightListInputs::receivers wants them.
gl::Buffer receiverDepths(gl::Device& device, const ReceiverInputs& inputs);

}  // namespace sfumato::pipelines
