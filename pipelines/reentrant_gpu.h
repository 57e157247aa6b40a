// Deferred shading whose passes can be run again (Chapman, "Deferred Rendering, Transparency & Alpha
// Blending"): the opaque surfaces are drawn into a G-buffer and lit; then, again and again, translucent ones
// are drawn into the same G-buffer, which marks in the stencil where they are; what they let through of the
// finished light behind them is gathered as the 'background'; under the mask the light is cleared, the
// surfaces are lit, and the background is added.
//
// The article's two materials are two corners of ours, where t = 1 - a (1 - tau b) passes and a (1 - tau) b
// is reflected diffusely: glass-like, a = tau = 1: black diffuse, background times b, added; smoke-like, tau
// = 0: diffuse times a, background times 1 - a, alpha blending. The shininess of either is light at the
// surface.
//
// The known limits are kept. Passes::One: only the nearest translucent surface of a pixel is seen.
// Passes::PerObject: of every instance the nearest of its back faces, then of its front faces, which is all
// of a convex one; instances are sorted by the depth of their centres, and where that is wrong, or where they
// intersect, what lies behind one that was drawn before is missing. Refraction shifts what is read from the
// finished light, which does not hold what is hidden there by something in front of the surface: where it
// would read that, it reads straight ahead, so that such things have a rim without refraction in place of the
// article's halo.
#pragma once

#include <optional>
#include <vector>

#include "gl/texture.h"
#include "pipelines/layers_gpu.h"
#include "pipelines/pipeline_gpu.h"
#include "pipelines/scene_gpu.h"

namespace sfumato::pipelines {

class ReentrantPipeline : public Pipeline {
 public:
  using Pipeline::Pipeline;

  // Costs, however many passes, a pixel's layer and ray (pipelines/layers_gpu.h), and 20 bytes of finished
  // light, 12 in table storage.
  Frame render(const scene::Camera& camera, int width, int height, const Quality& quality,
               const FrameOptions& options = {}) override;
};

// What the camera would see if there were nothing in front of what was drawn so far, without the smoke before
// it.
struct FinishedLight {
  gl::Texture radiance;  // RGBA32F; in table storage RGBA16F
  SurfaceLayer seen;     // only its depth
};

FinishedLight noLight(const LayeredFrame& frame);

// What is drawn after the opaque surfaces, in this order; that of one object within the rectangle in which it
// may be seen, outside which its passes leave everything as it is.
std::vector<LayerDraw> translucentPasses(const LayeredFrame& frame, const FinishedLight& finished);

// Puts the light of a layer's surfaces, and the background they let through where there are rays with it, in
// the place of what the mask passes. Of the layer's stencil, where 1 is set by `drawn`.
constexpr gl::StencilTest drawn{.reference = 1, .passed = gl::StencilChange::Replace};
constexpr gl::StencilTest whereDrawn{.compare = gl::Compare::Equal, .reference = 1};
void shadeOver(LayeredFrame& frame, const SurfaceLayer& layer, const Walk* background, const Mask& mask,
               const FinishedLight& light);

// Draws a pass into the layer, and what it shows over the finished light.
void drawOver(LayeredFrame& frame, const LayerDraw& pass, const SurfaceLayer& layer,
              const FinishedLight& finished, Walk& walk);

}  // namespace sfumato::pipelines
