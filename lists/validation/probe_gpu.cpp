#include "lists/validation/probe_gpu.h"

#include <chrono>

#include "gl/commands.h"
#include "gl/texture.h"

namespace sfumato::lists::validation {

const gl::Program& probeProgram(const Context& context, std::vector<std::string> files,
                                gl::ShaderDefines defines) {
  for (std::string& file : files) file.insert(0, "lists/validation/");
  defines.emplace_back("GATE_TRIES", interpreted(context.device) ? "1u" : "32u");
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

gl::ShaderDefines Patches::defines() const {
  return {{"GRID", std::to_string(grid) + "u"}, {"PATCH", std::to_string(patch) + "u"}};
}

void drawPatches(gl::Device& device, const gl::Program& program, const Patches& patches) {
  drawLayers(device, program, static_cast<int>(patches.grid) * 64, patches.layers);
}

size_t sized(const Context& context, size_t small, size_t full) {
  if (context.scale == Scale::Full) return full;
  return interpreted(context.device) ? small / 4 : small;
}

bool interpreted(const gl::Device& device) {
  return device.names().renderer.find("softpipe") != std::string::npos;
}

bool untilSeen(const Context& context, double seconds, const std::function<bool()>& round) {
  const std::chrono::duration<double> time(context.scale == Scale::Full ? 5 * seconds : seconds);
  const auto start = std::chrono::steady_clock::now();
  do {
    if (round()) return true;
  } while (std::chrono::steady_clock::now() - start < time);
  return false;
}

}  // namespace sfumato::lists::validation
