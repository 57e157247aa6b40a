// The stencil-routed A-buffer (Ferko 2012, section 4.1; Myers and Bavoil 2007) beside deferred shading: every
// translucent fragment is routed into a sample of its own of a multisample image, by stencil values that
// differ from sample to sample and that all fragments count down. Then each pixel's samples are met from
// front to back, lit forward, and blended; what is behind them is lit deferred.
//
// Where a pixel has more fragments than samples, as many passes follow as the fullest pixel needs: pass k
// keeps fragments k S to (k + 1) S - 1, each pass in a layer of its own. Stencil values count to 255 only:
// later passes leave out what earlier ones kept, and count from the start again. So nothing is lost, and any
// number of lights is met, by the light lists of a pixel's cell.
//
// Fragments are made at the centres of pixels and tested against each sample's stencil value, as OpenGL has
// it where multisampling is off. Some drivers do not then test it for each sample (Mesa's llvmpipe): there it
// is on, and triangles are drawn as rectangles of whole pixels, of which a fragment is kept where the
// pixel's centre is in the triangle (shaders/scene/covering.glsl). Drivers that route neither way get one
// sample and a pass for each fragment.
#pragma once

#include "pipelines/pipeline_gpu.h"
#include "pipelines/scene_gpu.h"

namespace sfumato::pipelines {

// How fragments come into samples of their own.
struct Routing {
  int samples = 1;        // of a pixel, that fragments can be routed to
  bool covering = false;  // by rectangles of whole pixels
};

// Finds out what the driver does, by drawing into one pixel.
Routing routingOf(gl::Device& device);

class StencilRoutedPipeline : public Pipeline {
 public:
  StencilRoutedPipeline(gl::Device& device, const scene::Scene& scene, std::span<const volumes::Medium> media,
                        const volumes::GridOptions& gridOptions = {});

  // With S samples (DeferredOptions::samples, at most those that the driver routes to) and n fragments in the
  // fullest pixel a pixel costs, beside a layer, its light and its ray (pipelines/layers_gpu.h), 12 bytes, 8
  // S of stencil, and ceil(n / S) S times 48 bytes (20 in table storage). Where that is more than
  // Quality::lists allows, or 512 MiB, the image is drawn in bands of rows, one of them at least. Throws
  // Memory where a band has no room, or its fullest pixel more fragments than 2,048 layers hold.
  Frame render(const scene::Camera& camera, int width, int height, const Quality& quality,
               const FrameOptions& options = {}) override;

 private:
  Routing routing_;
};

}  // namespace sfumato::pipelines
