#include "pipelines/split_pixels_gpu.h"

#include "gl/commands.h"
#include "gl/program.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/resolve.h"

namespace sfumato::pipelines {

Split splitPixels(gl::Device& device, const SplitInputs& inputs) {
  const size_t pixels = inputs.window.pixels();
  Split split;
  if (inputs.gbuffer.samplePositions.size() == 1) {
    split.groups = gl::Buffer(device, "pixel groups", 0);
    return split;
  }
  gl::Buffer counters(device, "resolve counters", sizeof(shared::ResolveCounters));
  const gl::Program& program = device.program(
      {"pipelines/split.comp"}, {{"SAMPLES", std::to_string(inputs.gbuffer.samplePositions.size())}});
  size_t capacity = pixels / 8;
  for (;;) {
    split.groups = gl::Buffer(device, "pixel groups", (pixels + capacity) * sizeof(uint32_t));
    counters.clear();
    bindSurfaces(inputs.view, inputs.gbuffer, inputs.surfaces);
    split.groups.bindStorage(STORAGE_PIXEL_GROUPS);
    counters.bindStorage(STORAGE_COUNTERS);
    gl::dispatch(program, {gl::groupsFor(static_cast<size_t>(inputs.window.width), 8),
                           gl::groupsFor(static_cast<size_t>(inputs.window.height), 8), 1});
    gl::storageBarrier();
    split.count = counters.readValue<shared::ResolveCounters>().groups;
    if (split.count <= capacity) return split;
    capacity = split.count;
  }
}

void bindSurfaces(const gl::Buffer& view, const GBuffer& gbuffer, const lists::Lists& surfaces) {
  view.bindUniform(UNIFORM_VIEW);
  surfaces.bind(TEXTURE_LIST_RUNS, TEXTURE_LIST_KEYS, TEXTURE_LIST_PAYLOADS);
  gbuffer.depth.bind(TEXTURE_OPAQUE_DEPTH);
  gbuffer.surface0.bind(TEXTURE_SURFACE_0);
  gbuffer.surface1.bind(TEXTURE_SURFACE_1);
}

}  // namespace sfumato::pipelines
