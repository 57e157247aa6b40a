// Checks of the context itself: is there what list code needs, and does the driver say when it fails.
#include <fmt/format.h>

#include "base/error.h"
#include "gl/commands.h"
#include "gl/shader_source.h"
#include "lists/validation/probe_gpu.h"

namespace sfumato::lists::validation {
namespace {

const std::vector<std::string> everyStrategy = {"spinlock", "lockfree", "append", "count"};

struct Need {
  const char* name;
  int64_t is;
  int64_t needed;
};

std::vector<Figure> extensionFigures(const gl::Device& device) {
  std::vector<Figure> figures;
  for (const char* extension :
       {"GL_ARB_fragment_shader_interlock", "GL_KHR_shader_subgroup", "GL_ARB_shader_ballot",
        "GL_NV_shader_atomic_int64", "GL_NV_shader_atomic_float", "GL_ARB_sparse_buffer"})
    figures.emplace_back(extension, device.has(extension) ? "present" : "absent");
  return figures;
}

Result context(const Context& context) {
  const gl::Limits& limits = context.device.limits();
  const Need needs[] = {
      {"storage bindings", limits.storageBindings, gl::storageBindingsUsed},
      {"storage blocks in a compute shader", limits.computeStorageBlocks, gl::storageBlocksUsed},
      {"storage blocks in a fragment shader", limits.fragmentStorageBlocks, 6},
      {"bytes in a storage block", limits.storageBlockBytes, int64_t{1} << 24},
  };
  Result result;
  for (const Need& need : needs) {
    result.figures.emplace_back(need.name, need.is);
    if (need.is >= need.needed) continue;
    result.verdict = Verdict::Fail;
    result.finding += fmt::format("{}{} {}, {} are needed", result.finding.empty() ? "" : "; ", need.is,
                                  need.name, need.needed);
    result.meaning = "the engine refuses this driver";
  }
  result.figures.emplace_back("timer bits", int64_t{limits.timerBits});
  for (Figure& figure : extensionFigures(context.device)) result.figures.push_back(std::move(figure));
  if (result.verdict == Verdict::Pass && limits.timerBits == 0)
    result.meaning = "no GPU timer: passes are timed by the wall clock";
  return result;
}

bool isStage(const std::string& name) {
  return name.ends_with(".vert") || name.ends_with(".geom") || name.ends_with(".frag") ||
         name.ends_with(".comp");
}

// The shaders of lists are left to the checks of the group `engine`, which run them.
Result shaders(const Context& context) {
  // What the engine defines when it compiles them: all that a scene may have, and all ways to store a node.
  std::vector<gl::ShaderDefines> variants;
  for (const char* pass : {"0", "1", "2", "3", "4"})
    variants.push_back({{"SAMPLES", "4"},
                        {"TEXTURES", "1"},
                        {"SMOKE", "1"},
                        {"SMOKE_BLOCKS", "1"},
                        {"VOLUME_COUNT", "2"},
                        {"GRID_COUNT", "2"},
                        {"GRID_BRICKS", "2"},
                        {"GRID_BRICK_SIDE", "8"},
                        {"SURFACES", "1"},
                        {"SHADOW_OBJECTS", "1"},
                        {"AMBIENT", "1"},
                        {"SSAO", "2"},
                        {"ROUTED_SAMPLES", "4"},
                        {"LIST_PASS", pass}});
  int64_t compiled = 0;
  Result result;
  for (const gl::EmbeddedShader& shader : gl::embeddedShaders()) {
    const std::string name(shader.name);
    if (!isStage(name) || name.starts_with("lists/")) continue;
    for (const gl::ShaderDefines& defines : variants) {
      ++compiled;
      const std::string problem = gl::compileProblem(context.device, name, defines);
      if (problem.empty()) continue;
      result.verdict = Verdict::Fail;
      if (result.finding.empty()) result.finding = problem.substr(0, problem.find('\n'));
      result.meaning = "the engine does not run on this driver";
    }
  }
  result.figures = {{"compiled", compiled}};
  return result;
}

Result reset(const Context& context) {
  if (!context.device.tellsResets())
    return {Verdict::Skip,
            "no context that tells of resets, or no GL_KHR_robustness",
            "a reset would be seen only as wrong results",
            {}};
  return {Verdict::Pass, "the status was asked for after every check", {}, {}};
}

}  // namespace

std::vector<Check> contextChecks() {
  return {
      {.name = "ctx",
       .group = "context",
       .does = "OpenGL 4.3 core without a window, with the limits that the engine needs",
       .strategies = everyStrategy,
       .run = context},
      {.name = "shaders",
       .group = "context",
       .does = "the driver's compiler takes every shader of the engine",
       .strategies = everyStrategy,
       .run = shaders},
      {.name = "reset",
       .group = "context",
       .does = "the driver says when it has reset a context",
       .run = reset},
  };
}

}  // namespace sfumato::lists::validation
