// What the G-buffer, the lists and the deep shadow maps tell of each pixel.
#pragma once

#include "deepshadow/maps_gpu.h"
#include "gl/buffer.h"
#include "gl/device.h"
#include "lights/light_lists_gpu.h"
#include "lists/lists_gpu.h"
#include "pipelines/aovs.h"
#include "pipelines/gbuffer_gpu.h"
#include "pipelines/scene_gpu.h"
#include "pipelines/tiles.h"

namespace sfumato::pipelines {

struct AovInputs {
  const gl::Buffer& view;  // shared::ViewParams, whose window is `window`
  const GBuffer& gbuffer;
  const lists::Lists& surfaces;
  const lights::LightLists& lights;
  const deepshadow::Maps& shadows;
  Tile window;
};

// Writes every AOV but the transmittance into the window's pixels of the images that are there. Costs 40
// bytes a pixel of the window. Counts end at 20,000.
void drawAovs(gl::Device& device, const AovInputs& inputs, AovImages& images);

// Depth and normal alone, of an image that was drawn in any way: draws the opaque surfaces once more, one
// sample a pixel, tile by tile. Costs 40 bytes a pixel of a tile.
void drawSurfaceAovs(const SceneGpu& scene, const scene::Camera& camera, AovImages& images);

}  // namespace sfumato::pipelines
