#include "pipelines/surface_lists_gpu.h"

#include "gl/commands.h"
#include "gl/program.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/surface.h"

namespace sfumato::pipelines {

SurfaceLists buildSurfaceLists(gl::Device& device, const SurfaceListInputs& inputs) {
  const size_t pixels = static_cast<size_t>(inputs.width) * static_cast<size_t>(inputs.height);
  SurfaceLists result{
      lists::LinkedLists(device, "surface lists", pixels, sizeof(shared::PackedSurface), pixels / 4), {}};
  const auto samples = static_cast<int>(inputs.gbuffer.samplePositions.size());
  const gl::Framebuffer noTarget({inputs.width, inputs.height}, samples);
  result.statistics = result.lists.build(device, [&] {
    if (!inputs.geometry.has(Layer::Translucent)) return;
    inputs.view.bindUniform(UNIFORM_VIEW);
    inputs.gbuffer.depth.bind(TEXTURE_OPAQUE_DEPTH);
    gl::setDrawState({.program = &device.program({"scene/surface.vert", "pipelines/translucent.frag"},
                                                 {{"SAMPLES", std::to_string(samples)}}),
                      .target = &noTarget,
                      .viewport = {0, 0, inputs.width, inputs.height}});
    inputs.geometry.draw(Layer::Translucent, true);
  });
  return result;
}

}  // namespace sfumato::pipelines
