// Passes over the rays of a window's pixels, and over those that stand for blocks of them.
#pragma once

#include "deepshadow/maps_gpu.h"
#include "gl/buffer.h"
#include "gl/program.h"
#include "lights/light_lists_gpu.h"
#include "pipelines/frame_gpu.h"
#include "pipelines/scene_gpu.h"
#include "pipelines/split_pixels_gpu.h"
#include "shaders/shared/resolve.h"

namespace sfumato::pipelines {

struct RayInputs {
  const gl::Buffer& view;
  const GBuffer& gbuffer;
  const lists::Lists& surfaces;
  const Split& split;
  const lights::LightLists& lights;
  const deepshadow::Maps& shadows;
  const SceneGpu& scene;
  const Quality& quality;
  Tile window;
  int smokeBlockSide;  // pixels
  bool countLookups;
};

// Of a first dispatch, but for the number of its rays.
shared::ResolveParams rayParams(const RayInputs& inputs);

class RayPass {
 public:
  RayPass(gl::Device& device, const RayInputs& inputs);
  // One dispatch, over `params.options.w` rays. What only one pass reads or writes is bound before.
  shared::ResolveCounters dispatch(const gl::Program& program, const shared::ResolveParams& params);

 private:
  const RayInputs& inputs_;
  gl::Buffer passBlock_;
  gl::Buffer counters_;
};

// What a ray looked up (COUNT_LOOKUPS), to that of all.
void add(const glm::u64vec4& counted, Lookups& all);

}  // namespace sfumato::pipelines
