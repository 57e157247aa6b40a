// A way to draw a frame. All of them draw the same scenes, with the same materials and lights.
#pragma once

#include "pipelines/frame_gpu.h"
#include "pipelines/quality.h"
#include "scene/scene.h"

namespace sfumato::pipelines {

class Pipeline {
 public:
  virtual ~Pipeline() = default;
  virtual Frame render(const scene::Camera& camera, int width, int height, const Quality& quality,
                       const FrameOptions& options = {}) = 0;
};

}  // namespace sfumato::pipelines
