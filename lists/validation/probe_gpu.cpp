#include "lists/validation/probe_gpu.h"

#include "gl/commands.h"
#include "gl/texture.h"

namespace sfumato::lists::validation {

const gl::Program& probeProgram(const Context& context, std::vector<std::string> files,
                                gl::ShaderDefines defines) {
  for (std::string& file : files) file.insert(0, "lists/validation/");
  if (!context.mutant.empty()) defines.emplace_back("MUTANT_" + context.mutant, "1");
  return context.device.program(files, defines);
}

gl::Buffer zeroWords(gl::Device& device, size_t count) {
  gl::Buffer words(device, "validation", count * sizeof(uint32_t));
  words.clear();
  return words;
}

void drawLayers(gl::Device& device, const gl::Program& program, int side, size_t layers) {
  const gl::Framebuffer nothing(glm::ivec2(side, side));
  gl::setDrawState({.program = &program, .target = &nothing, .viewport = {0, 0, side, side}});
  gl::drawGenerated(device, 3, layers);
}

}  // namespace sfumato::lists::validation
