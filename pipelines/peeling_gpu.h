// Deferred depth peeling (Aladagli 2015, section 4.1.2, there with one translucent layer): the opaque
// surfaces and each layer of translucent ones get a G-buffer and light of their own, from front to back until
// nothing is left, or as many as are asked for. Without that limit it is exact.
#pragma once

#include "pipelines/layers_gpu.h"
#include "pipelines/pipeline_gpu.h"

namespace sfumato::pipelines {

class PeelingPipeline : public Pipeline {
 public:
  using Pipeline::Pipeline;

  // Costs two G-buffers and two lights more than one layer does (pipelines/layers_gpu.h), however many
  // layers.
  Frame render(const scene::Camera& camera, int width, int height, const Quality& quality,
               const FrameOptions& options = {}) override;
};

// The picture of at most so many translucent layers before the opaque one; 0: of all.
Frame peel(LayeredFrame& frame, int mostLayers);

}  // namespace sfumato::pipelines
