// What the probes of several groups of checks need.
#pragma once

#include <string>

#include "gl/buffer.h"
#include "gl/program.h"
#include "lists/validation/check.h"

namespace sfumato::lists::validation {

// A program of shaders/lists/validation, built with these defines and the context's mutant.
const gl::Program& probeProgram(const Context& context, std::vector<std::string> files,
                                gl::ShaderDefines defines = {});

// `count` words, all 0.
gl::Buffer zeroWords(gl::Device& device, size_t count);

// Draws `layers` triangles over the whole of a square of `side` pixels, with nothing attached: only the side
// effects of its fragments stay.
void drawLayers(gl::Device& device, const gl::Program& program, int side, size_t layers);

}  // namespace sfumato::lists::validation
