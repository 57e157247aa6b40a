// What the probes of several groups of checks need.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "gl/buffer.h"
#include "gl/program.h"
#include "gl/shader_source.h"
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

// Squares of pixels that fragments do something in, 64 pixels apart, so that each stands in another tile of a
// driver that gives tiles to threads. No triangle ends inside one: all lanes are live
// (shaders/lists/validation/patches.glsl).
struct Patches {
  size_t grid = 2;    // so many in a row, and rows
  size_t patch = 32;  // pixels a side, at most 64
  size_t layers = 1;  // one over the other

  size_t pixels() const { return grid * grid * patch * patch; }
  size_t fragments() const { return pixels() * layers; }
  gl::ShaderDefines defines() const;
};
void drawPatches(gl::Device& device, const gl::Program& program, const Patches& patches);

// `small` or `full`, as the context asks; a quarter of `small` where shaders are interpreted (softpipe),
// which is some hundred times slower.
size_t sized(const Context& context, size_t small, size_t full);

// Whether the driver interprets shaders (softpipe).
bool interpreted(const gl::Device& device);

// Calls `round` until it is true or so many seconds are over (five times as many at full scale); whether it
// was. What runs at the same time depends on the operating system too: a control may need many rounds until
// it fails.
bool untilSeen(const Context& context, double seconds, const std::function<bool()>& round);

}  // namespace sfumato::lists::validation
