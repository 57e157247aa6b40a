#include "pipelines/gbuffer_gpu.h"

#include "gl/commands.h"
#include "gl/program.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/deepshadow.h"

namespace sfumato::pipelines {

GBuffer drawGBuffer(gl::Device& device, const GBufferInputs& inputs) {
  const glm::ivec3 size(inputs.width, inputs.height, 1);
  GBuffer result{gl::Texture(device, "G-buffer surface 0", {.format = gl::Format::RGBA32UI, .size = size}),
                 gl::Texture(device, "G-buffer surface 1", {.format = gl::Format::RGBA32UI, .size = size}),
                 gl::Texture(device, "G-buffer depth", {.format = gl::Format::R32F, .size = size})};
  const gl::Texture depthTest(device, "depth test", {.format = gl::Format::Depth32F, .size = size});
  const gl::Texture* colours[] = {&result.surface0, &result.surface1, &result.depth};
  const gl::Framebuffer target(colours, &depthTest);
  target.clearColour(0, glm::uvec4(0));
  target.clearColour(1, glm::uvec4(0));
  target.clearColour(2, glm::vec4(static_cast<float>(NOTHING_OPAQUE)));
  target.clearDepth(1.f);
  inputs.view.bindUniform(UNIFORM_VIEW);
  gl::setDrawState({.program = &device.program({"scene/surface.vert", "pipelines/gbuffer.frag"}),
                    .target = &target,
                    .viewport = {0, 0, inputs.width, inputs.height},
                    .depthTest = true});
  inputs.geometry.draw(Layer::Opaque, true);
  return result;
}

}  // namespace sfumato::pipelines
