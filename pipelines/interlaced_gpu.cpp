#include "pipelines/interlaced_gpu.h"

#include "pipelines/peeling_gpu.h"
#include "shaders/shared/bindings.h"

namespace sfumato::pipelines {

Frame composeInterlaced(LayeredFrame& frame, const gl::ShaderDefines& defines,
                        const std::function<void()>& bindInputs) {
  Walk walk = frame.startWalk();
  {
    const gl::Profiler::Scope time(frame.device().profiler(), "composition");
    const gl::Program& program = frame.device().program(
        {"pipelines/interlaced.comp"},
        gl::joined(gl::joined(frame.lightingDefines(), frame.interlaceDefines()), defines));
    frame.dispatchWalk(program, frame.params(), bindInputs, walk);
  }
  return frame.finish(walk);
}

Frame InterlacedPipeline::render(const scene::Camera& camera, int width, int height, const Quality& quality,
                                 const FrameOptions& options) {
  LayeredFrame frame(scene_, camera, width, height, quality, {ShadowKind::Interlaced, true});
  options.onTile();
  if (quality.deferred.interlace == Interlace::Full) return peel(frame, 1);
  const SurfaceLayer layer = frame.layer("interlaced layer");
  frame.draw(layer, {.surfaces = LayerDraw::Surfaces::Interlaced});
  const gl::Texture light = frame.light(layer);
  return composeInterlaced(frame, {}, [&] {
    layer.bind();
    light.bind(TEXTURE_LAYER_LIGHT);
  });
}

}  // namespace sfumato::pipelines
