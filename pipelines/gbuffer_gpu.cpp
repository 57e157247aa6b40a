#include "pipelines/gbuffer_gpu.h"

#include <algorithm>

#include "gl/commands.h"
#include "gl/program.h"
#include "shaders/shared/bindings.h"

namespace sfumato::pipelines {

void drawOpaque(gl::Device& device, const GeometryGpu& geometry, gl::DrawState state,
                const gl::Texture& depthTest, bool depthsFirst) {
  state.depthTest = true;
  if (depthsFirst) {
    const gl::Framebuffer depthsOnly(std::span<const gl::Texture* const>(), &depthTest);
    gl::DrawState first = state;
    first.program = &device.program({"scene/surface.vert", "pipelines/depth_only.frag"}, geometry.defines());
    first.target = &depthsOnly;
    first.stencil.reset();
    gl::setDrawState(first);
    geometry.draw(Layer::Opaque, true);
    state.depthCompare = gl::Compare::Equal;
    state.depthWrite = false;
  }
  gl::setDrawState(state);
  geometry.draw(Layer::Opaque, true);
}

GBuffer drawGBuffer(gl::Device& device, const GBufferInputs& inputs) {
  const Tile tile = inputs.tile.value_or(Tile{0, 0, inputs.width, inputs.height});
  const glm::ivec3 size(tile.width, tile.height, 1);
  const int samples = inputs.samples > 1 ? inputs.samples : 0;  // one sample is an ordinary texture
  const bool drawn = inputs.geometry.has(Layer::Opaque);
  const glm::ivec3 sizeWhereDrawn = drawn ? size : glm::ivec3(1);
  GBuffer result{
      gl::Texture(device, "G-buffer surface 0",
                  {.format = gl::Format::RGBA32UI, .size = sizeWhereDrawn, .samples = samples}),
      gl::Texture(device, "G-buffer surface 1",
                  {.format = gl::Format::RGBA32UI, .size = sizeWhereDrawn, .samples = samples}),
      gl::Texture(device, "G-buffer depth", {.format = gl::Format::R32F, .size = size, .samples = samples}),
      std::nullopt,
      tile,
      {}};
  const gl::Texture depthTest(device, "depth test",
                              {.format = gl::Format::Depth32F, .size = sizeWhereDrawn, .samples = samples});
  std::vector<const gl::Texture*> colours;
  if (drawn) colours = {&result.surface0, &result.surface1};
  const auto depthNumber = static_cast<int>(colours.size());
  colours.push_back(&result.depth);
  gl::ShaderDefines defines = inputs.geometry.defines();
  if (inputs.baseColour) {
    result.baseColour.emplace(
        device, "G-buffer base colour",
        gl::TextureDescription{.format = gl::Format::RGBA16F, .size = size, .samples = samples});
    colours.push_back(&*result.baseColour);
    defines.emplace_back("BASE_COLOUR", "1");
  }
  const gl::Framebuffer target(colours, drawn ? &depthTest : nullptr);
  for (int i = 0; i < depthNumber; ++i) target.clearColour(i, glm::uvec4(0));
  target.clearColour(depthNumber, glm::vec4(static_cast<float>(NOTHING_SEEN)));
  if (inputs.baseColour) target.clearColour(depthNumber + 1, glm::vec4(0.f));
  if (drawn) {
    target.clearDepth(1.f);
    inputs.view.bindUniform(UNIFORM_VIEW);
    drawOpaque(device, inputs.geometry,
               {.program = &device.program({"scene/surface.vert", "pipelines/gbuffer.frag"}, defines),
                .target = &target,
                .viewport = {-tile.x, -tile.y, inputs.width, inputs.height}},
               depthTest, inputs.depthsFirst);
  }
  result.samplePositions = target.samplePositions();
  // A driver may give more than were asked for; any of them will do.
  if (result.samplePositions.size() > MAX_SAMPLES) result.samplePositions.resize(MAX_SAMPLES);
  return result;
}

void setSamples(shared::ResolveParams& params, const GBuffer& gbuffer) {
  glm::vec2 positions[MAX_SAMPLES] = {};
  std::copy(gbuffer.samplePositions.begin(), gbuffer.samplePositions.end(), positions);
  params.samples01 = glm::vec4(positions[0], positions[1]);
  params.samples23 = glm::vec4(positions[2], positions[3]);
}

}  // namespace sfumato::pipelines
