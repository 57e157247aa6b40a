#include "pipelines/surface_lists_gpu.h"

#include "gl/commands.h"
#include "gl/program.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/surface.h"

namespace sfumato::pipelines {

namespace {

Tile windowOf(const SurfaceListInputs& inputs) {
  return inputs.window.value_or(inputs.gbuffer.tile);
}

SurfaceLists emptyLists(gl::Device& device, const SurfaceListInputs& inputs) {
  const size_t pixels = windowOf(inputs).pixels();
  return {lists::Lists(device, "surface lists", pixels, sizeof(shared::PackedSurface), inputs.lists), {}};
}

// Fragments are those of the whole tile, so that a pixel's list is the same whatever the window.
void storeSurfaces(gl::Device& device, const SurfaceListInputs& inputs, const lists::Pass& pass) {
  if (!inputs.geometry.has(Layer::Translucent)) return;
  const Tile& tile = inputs.gbuffer.tile;
  const Tile window = windowOf(inputs);
  const auto samples = static_cast<int>(inputs.gbuffer.samplePositions.size());
  const gl::Framebuffer noTarget({tile.width, tile.height}, samples);
  gl::ShaderDefines defines = gl::joined(inputs.geometry.defines(), pass.defines);
  defines.emplace_back("SAMPLES", std::to_string(samples));
  inputs.view.bindUniform(UNIFORM_VIEW);
  inputs.gbuffer.depth.bind(TEXTURE_OPAQUE_DEPTH);
  gl::setDrawState(
      {.program = &device.program({"scene/surface.vert", "pipelines/translucent.frag"}, defines),
       .target = &noTarget,
       .viewport = {-tile.x, -tile.y, inputs.width, inputs.height},
       .scissor = glm::ivec4(window.x - tile.x, window.y - tile.y, window.width, window.height)});
  inputs.geometry.draw(Layer::Translucent, true);
}

// Nodes that nobody can see, which are never stored.
size_t hiddenNodes(gl::Device& device, const SurfaceListInputs& inputs, const lists::Lists& lists) {
  const auto samples = std::to_string(inputs.gbuffer.samplePositions.size());
  const gl::Program& program = device.program({"pipelines/hidden_surfaces.comp"}, {{"SAMPLES", samples}});
  gl::Buffer hidden(device, "hidden surfaces", sizeof(uint32_t));
  hidden.clear();
  inputs.view.bindUniform(UNIFORM_VIEW);
  lists.bind(TEXTURE_LIST_RUNS, TEXTURE_LIST_KEYS, TEXTURE_LIST_PAYLOADS);
  inputs.gbuffer.depth.bind(TEXTURE_OPAQUE_DEPTH);
  hidden.bindStorage(STORAGE_COUNTERS);
  gl::dispatchLinear(program, windowOf(inputs).pixels());
  gl::storageBarrier();
  return hidden.readValue<uint32_t>();
}

void setStatistics(gl::Device& device, const SurfaceListInputs& inputs,
                   const lists::ListStatistics& statistics, SurfaceLists& result) {
  result.statistics = statistics;
  if (statistics.stored > 0) result.statistics.hidden = hiddenNodes(device, inputs, result.lists);
}

}  // namespace

SurfaceLists buildSurfaceLists(gl::Device& device, const SurfaceListInputs& inputs) {
  SurfaceLists result = emptyLists(device, inputs);
  const auto statistics =
      result.lists.build(device, [&](const lists::Pass& pass) { storeSurfaces(device, inputs, pass); });
  setStatistics(device, inputs, statistics, result);
  return result;
}

std::optional<SurfaceLists> tryBuildSurfaceLists(gl::Device& device, const SurfaceListInputs& inputs) {
  SurfaceLists result = emptyLists(device, inputs);
  const auto statistics =
      result.lists.tryBuild(device, windowOf(inputs).pixels(),
                            [&](const lists::Pass& pass) { storeSurfaces(device, inputs, pass); });
  if (!statistics) return std::nullopt;
  setStatistics(device, inputs, *statistics, result);
  return result;
}

}  // namespace sfumato::pipelines
