#include "pipelines/receivers_gpu.h"

#include "gl/commands.h"
#include "gl/program.h"
#include "lights/light_lists_gpu.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/resolve.h"

namespace sfumato::pipelines {

gl::Buffer receiverDepths(gl::Device& device, const ReceiverInputs& inputs) {
  const size_t cells =
      lights::LightLists::cellsOf(inputs.width, inputs.height, inputs.window.corners()).number();
  gl::Buffer depths(device, "receiver depths", cells * sizeof(glm::vec2));
  gl::Buffer passBlock(device, "receiver pass", sizeof(shared::ResolveParams));
  shared::ResolveParams params{};
  setSamples(params, inputs.gbuffer);
  passBlock.writeValue(params);
  gl::ShaderDefines defines = {{"SAMPLES", std::to_string(inputs.gbuffer.samplePositions.size())}};
  if (!inputs.volumes.empty()) {
    defines.emplace_back("SMOKE", "1");
    defines = gl::joined(defines, inputs.volumes.defines());
  }

  inputs.view.bindUniform(UNIFORM_VIEW);
  passBlock.bindUniform(UNIFORM_PASS);
  inputs.gbuffer.depth.bind(TEXTURE_OPAQUE_DEPTH);
  inputs.gbuffer.surface0.bind(TEXTURE_SURFACE_0);
  inputs.surfaces.bind(TEXTURE_LIST_RUNS, TEXTURE_LIST_KEYS, TEXTURE_LIST_PAYLOADS);
  inputs.pixelGroups.bindStorage(STORAGE_PIXEL_GROUPS);
  inputs.volumes.bind();
  depths.bindStorage(STORAGE_RECEIVER_DEPTHS);
  gl::dispatchLinear(device.program({"pipelines/receivers.comp"}, defines), cells);
  gl::storageBarrier();
  return depths;
}

}  // namespace sfumato::pipelines
