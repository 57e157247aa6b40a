#include "pipelines/peeling_gpu.h"

#include <limits>
#include <utility>

namespace sfumato::pipelines {

Frame peel(LayeredFrame& frame, int mostLayers) {
  const SurfaceLayer opaque = frame.layer("opaque layer");
  frame.draw(opaque, {});
  Walk walk = frame.startWalk();
  if (frame.scene().geometry().has(Layer::Translucent)) {
    const int most = mostLayers > 0 ? mostLayers : std::numeric_limits<int>::max();
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
  return frame.finish(walk);
}

Frame PeelingPipeline::render(const scene::Camera& camera, int width, int height, const Quality& quality,
                              const FrameOptions& options) {
  LayeredFrame frame(scene_, camera, width, height, quality);
  options.onTile();
  return peel(frame, quality.deferred.layers);
}

}  // namespace sfumato::pipelines
