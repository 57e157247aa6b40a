// The core pipeline, after Lindbeck 2015: opaque G-buffer, light linked lists, deep shadow maps, exact
// per-pixel lists of translucent surfaces, and a resolve that walks a pixel's surfaces and marches the smoke
// between them.
#pragma once

#include <span>

#include "pipelines/pipeline_gpu.h"
#include "pipelines/scene_gpu.h"

namespace sfumato::pipelines {

class LinkedListsPipeline : public Pipeline {
 public:
  using Pipeline::Pipeline;

  void prepare(const scene::Camera& camera, int height, const Quality& quality,
               const FrameOptions& options) override;
  // Draws one frame, tile by tile (pipelines/tiles.h): each pixel is the same bits whatever the device can
  // hold at a time, but where a ray through smoke stands for pixels of two tiles. Bytes: 12 a pixel on the
  // host; of a tile 40 a sample for the G-buffer, 12 to 60 a ray (resolve_gpu.h), 52 a translucent fragment
  // and those of its light lists; and the deep shadow maps. Throws Memory when the maps, or the lists of a
  // single pixel, are over the device's limits.
  Frame render(const scene::Camera& camera, int width, int height, const Quality& quality,
               const FrameOptions& options = {}) override;

 private:
  deepshadow::Maps shadows_;  // of the last frame
};

}  // namespace sfumato::pipelines
