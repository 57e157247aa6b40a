#include "pipelines/peeling_gpu.h"

#include <limits>
#include <utility>

#include "pipelines/layers_gpu.h"

namespace sfumato::pipelines {

PeelingPipeline::PeelingPipeline(gl::Device& device, const scene::Scene& scene,
                                 std::span<const volumes::Medium> media,
                                 const volumes::GridOptions& gridOptions)
    : scene_(device, scene, media, gridOptions) {}

Frame PeelingPipeline::render(const scene::Camera& camera, int width, int height, const Quality& quality,
                              const FrameOptions& options) {
  LayeredFrame frame(scene_, camera, width, height, quality);
  const SurfaceLayer opaque = frame.layer("opaque layer");
  frame.draw(opaque, {});
  Walk walk = frame.startWalk();
  if (scene_.geometry().has(Layer::Translucent)) {
    const int most = frame.options().layers > 0 ? frame.options().layers : std::numeric_limits<int>::max();
    SurfaceLayer layer = frame.layer("translucent layer", true);
    SurfaceLayer before = frame.layer("translucent layer", true);
    for (int i = 0; i < most; ++i) {
      frame.draw(layer, {.surfaces = LayerDraw::Surfaces::Translucent,
                         .before = &opaque,
                         .behind = i > 0 ? &before : nullptr});
      if (frame.walkTo(layer, frame.light(layer), false, walk) == 0) break;
      std::swap(layer, before);
    }
  }
  frame.walkTo(opaque, frame.light(opaque), true, walk);
  options.onTile();
  return frame.finish(walk);
}

}  // namespace sfumato::pipelines
