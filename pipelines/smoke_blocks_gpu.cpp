#include "pipelines/smoke_blocks_gpu.h"

#include <algorithm>

#include "gl/commands.h"
#include "shaders/shared/bindings.h"

namespace sfumato::pipelines {

using gl::Profiler;

namespace {

constexpr size_t knotBytes = sizeof(glm::uvec4);

size_t blocksAlong(int first, int pixels, int side) {
  return static_cast<size_t>((first + pixels + side - 1) / side - first / side);
}

gl::Buffer grown(gl::Device& device, const char* label, const gl::Buffer& buffer, size_t bytes) {
  gl::Buffer result(device, label, buffer.bytes() + bytes);
  if (buffer.bytes() > 0) result.copyFrom(buffer, buffer.bytes());
  return result;
}

}  // namespace

SmokeBlocks::SmokeBlocks(gl::Device& device, const RayInputs& inputs, const gl::ShaderDefines& defines,
                         FrameStatistics& statistics) {
  const Profiler::Scope time(device.profiler(), "smoke");
  const int side = inputs.smokeBlockSide;
  const size_t count = blocksAlong(inputs.window.x, inputs.window.width, side) *
                       blocksAlong(inputs.window.y, inputs.window.height, side);
  shared::ResolveParams params = rayParams(inputs);
  params.blocks = {side, 0, 0, static_cast<int>(count)};
  params.options.w = static_cast<int>(count);
  march(device, inputs, device.program({"pipelines/smoke_blocks.comp"}, defines), params, statistics);

  const gl::Buffer parents(device, "smoke parents", count * sizeof(uint32_t));
  parents.bindStorage(STORAGE_SMOKE_PARENTS);
  bind();
  blocks_.bindStorage(STORAGE_RAYS);
  const size_t refined = RayPass(device, inputs)
                             .dispatch(device.program({"pipelines/smoke_refine.comp"}, defines), params)
                             .groups;
  if (refined == 0) return;
  params.options.w = static_cast<int>(refined) * side * side;
  parents.bindStorage(STORAGE_SMOKE_PARENTS);
  march(device, inputs,
        device.program({"pipelines/smoke_blocks.comp"}, gl::joined(defines, {{"REFINED", "1"}})), params,
        statistics);
}

void SmokeBlocks::bind() const {
  blockTexture_.bind(TEXTURE_SMOKE_BLOCKS);
  knotTexture_.bind(TEXTURE_SMOKE_KNOTS);
}

void SmokeBlocks::march(gl::Device& device, const RayInputs& inputs, const gl::Program& program,
                        shared::ResolveParams params, FrameStatistics& statistics) {
  const auto count = static_cast<size_t>(params.options.w);
  const size_t most = std::min(static_cast<size_t>(device.limits().textureBufferTexels),
                               static_cast<size_t>(device.limits().storageBlockBytes) / knotBytes);
  params.blocks.y = static_cast<int>((most - knots_) / count);
  params.blocks.z = -1;
  blocks_ = grown(device, "smoke blocks", blocks_, count * sizeof(shared::SmokeBlock));
  RayPass pass(device, inputs);
  blocks_.bindStorage(STORAGE_RAYS);
  const bool surfaces = inputs.scene.geometry().triangles() > 0;  // without them nothing stops in the smoke
  const size_t knots = surfaces ? pass.dispatch(program, params).groups : 0;
  params.blocks.z = static_cast<int>(knots_);
  knotBuffer_ = grown(device, "smoke knots", knotBuffer_, knots * knotBytes);
  knots_ += knots;
  const gl::Buffer lookups(device, "lookups", inputs.countLookups ? count * sizeof(glm::uvec4) : 0);
  for (shared::ResolveCounters counted{.unfinished = 1}; counted.unfinished > 0; params.options.x = 0) {
    knotBuffer_.bindStorage(STORAGE_SMOKE_KNOTS);
    lookups.bindStorage(STORAGE_LOOKUPS);
    counted = pass.dispatch(program, params);
    statistics.cutWalks += counted.boundHit;
  }
  if (inputs.countLookups)
    for (const glm::uvec4& ofBlock : lookups.readValues<glm::uvec4>(count)) add(ofBlock, statistics.lookups);
  blockTexture_ = gl::BufferTexture(device, blocks_, gl::BufferFormat::RGBA32F);
  knotTexture_ = gl::BufferTexture(device, knotBuffer_, gl::BufferFormat::RGBA32UI);
}

}  // namespace sfumato::pipelines
