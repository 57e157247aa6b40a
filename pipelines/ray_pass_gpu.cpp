#include "pipelines/ray_pass_gpu.h"

#include "gl/commands.h"
#include "pipelines/gbuffer_gpu.h"
#include "shaders/shared/bindings.h"

namespace sfumato::pipelines {

shared::ResolveParams rayParams(const RayInputs& inputs) {
  shared::ResolveParams params =
      inputs.scene.lightingParams(inputs.quality, inputs.lights.directionalLights());
  params.options.x = 1;
  setSamples(params, inputs.gbuffer);
  return params;
}

RayPass::RayPass(gl::Device& device, const RayInputs& inputs)
    : inputs_(inputs),
      passBlock_(device, "resolve pass", sizeof(shared::ResolveParams)),
      counters_(device, "resolve counters", sizeof(shared::ResolveCounters)) {}

shared::ResolveCounters RayPass::dispatch(const gl::Program& program, const shared::ResolveParams& params) {
  passBlock_.writeValue(params);
  counters_.clear();
  bindSurfaces(inputs_.view, inputs_.gbuffer, inputs_.surfaces);
  passBlock_.bindUniform(UNIFORM_PASS);
  inputs_.split.groups.bindStorage(STORAGE_PIXEL_GROUPS);
  counters_.bindStorage(STORAGE_COUNTERS);
  inputs_.lights.bind();
  inputs_.shadows.bind();
  inputs_.scene.volumes().bind();
  gl::dispatchLinear(program, static_cast<size_t>(params.options.w));
  gl::storageBarrier();
  return counters_.readValue<shared::ResolveCounters>();
}

void add(const glm::u64vec4& counted, Lookups& all) {
  all.lights += counted.x;
  all.shadows += counted.y;
  all.steps += counted.z;
  all.jumpedSteps += counted.w;
}

}  // namespace sfumato::pipelines
