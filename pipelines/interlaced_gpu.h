// Interlaced deferred transparency (Aladagli 2015): one G-buffer, in which translucent surfaces take every
// other line (or the pixels of a checkerboard) and what is behind them the rest, lit in one go; a last pass
// finds for each pixel what it lacks beside it. Beyond the thesis: smoke, a checkerboard, an upsample that
// smooths the edges of translucent surfaces, point and directional shadows, floats.
// One layer of translucent surfaces is seen, at half the resolution. Interlace::Full stores both in G-buffers
// of their own: then it is deferred peeling of one layer.
#pragma once

#include <functional>

#include "pipelines/layers_gpu.h"
#include "pipelines/pipeline_gpu.h"

namespace sfumato::pipelines {

class InterlacedPipeline : public Pipeline {
 public:
  using Pipeline::Pipeline;

  // Bytes a pixel: one layer and its light (pipelines/layers_gpu.h) and 32 of its ray.
  Frame render(const scene::Camera& camera, int width, int height, const Quality& quality,
               const FrameOptions& options = {}) override;
};

// What shaders/pipelines/interlaced.comp makes of an interlaced image, as it was bound by `bindInputs`.
Frame composeInterlaced(LayeredFrame& frame, const gl::ShaderDefines& defines,
                        const std::function<void()>& bindInputs);

}  // namespace sfumato::pipelines
