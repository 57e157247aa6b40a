// Forward multi-pass rendering (Aladagli 2015, section 4.1.3): all geometry is drawn again for every light
// and added up, translucent surfaces into every other line, and the interlaced image is composed as that of
// interlaced deferred transparency is. With depths, what is bent by a surface is taken from behind it;
// without (forward-mask), from wherever a translucent surface covers the image, with the errors of fig. 4.7:
// what is before a surface is seen in it, and what is behind it, but beside it in the image, is not. Smoke is
// marched against the depths in both.
#pragma once

#include "pipelines/layers_gpu.h"
#include "pipelines/pipeline_gpu.h"

namespace sfumato::pipelines {

class ForwardPipeline : public Pipeline {
 public:
  enum class Refraction { ByDepth, ByMask };
  ForwardPipeline(Refraction refraction, gl::Device& device, const scene::Scene& scene,
                  std::span<const volumes::Medium> media, const volumes::GridOptions& gridOptions = {});

  // Bytes a pixel: 16 of radiance, 8 of what is let through, 4 of the normal, 4 of depth, 8 of its test, 32
  // of the ray. Throws Usage for Interlace::Full.
  Frame render(const scene::Camera& camera, int width, int height, const Quality& quality,
               const FrameOptions& options = {}) override;

 private:
  Refraction refraction_;
};

}  // namespace sfumato::pipelines
