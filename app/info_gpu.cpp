// `sfumato info`: which GL devices there are, which one is used, and what its limits mean here.
#include <fmt/format.h>

#include <algorithm>

#include "app/options.h"
#include "base/json_text.h"
#include "base/log.h"
#include "gl/device.h"

namespace sfumato::app {
namespace {

struct Fact {
  std::string name;
  int64_t value;
  std::string shown;
  std::string consequence;
};

std::string mebibytes(int64_t bytes) {
  return fmt::format("{} MiB", bytes >> 20);
}

std::vector<Fact> facts(const gl::Limits& limits) {
  return {
      {"storage_block_bytes", limits.storageBlockBytes, mebibytes(limits.storageBlockBytes),
       fmt::format("a list pool holds up to {} million nodes of 12 bytes",
                   limits.storageBlockBytes / 12 / 1000000)},
      {"storage_bindings", limits.storageBindings, std::to_string(limits.storageBindings),
       fmt::format("the passes use {}", gl::storageBindingsUsed)},
      {"compute_storage_blocks", limits.computeStorageBlocks, std::to_string(limits.computeStorageBlocks),
       fmt::format("the resolve uses {}", gl::storageBlocksUsed)},
      {"fragment_storage_blocks", limits.fragmentStorageBlocks, std::to_string(limits.fragmentStorageBlocks),
       "lists are built while rasterising with 6"},
      {"texture_3d_size", limits.texture3dSize, std::to_string(limits.texture3dSize),
       fmt::format("volumes up to {} voxels a side", limits.texture3dSize)},
      {"texture_2d_size", limits.texture2dSize, std::to_string(limits.texture2dSize),
       fmt::format("images and shadow maps up to {} a side",
                   std::min(limits.texture2dSize, limits.framebufferSize))},
      {"timer_bits", limits.timerBits, std::to_string(limits.timerBits),
       limits.timerBits > 0 ? "passes are timed on the GPU" : "no GPU timer: only wall-clock times"},
  };
}

nlohmann::json toJson(const std::vector<gl::DeviceEntry>& devices, const gl::Device& used) {
  nlohmann::json result;
  for (const gl::DeviceEntry& device : devices)
    result["devices"].push_back({{"index", device.index},
                                 {"platform", device.names.platform},
                                 {"renderer", device.names.renderer},
                                 {"version", device.names.version},
                                 {"software", device.names.software},
                                 {"problem", device.problem}});
  result["device"] = {{"platform", used.names().platform},
                      {"vendor", used.names().vendor},
                      {"renderer", used.names().renderer},
                      {"version", used.names().version},
                      {"software", used.names().software}};
  for (const Fact& fact : facts(used.limits()))
    result["limits"][fact.name] = {{"value", fact.value}, {"consequence", fact.consequence}};
  return result;
}

void print(const std::vector<gl::DeviceEntry>& devices, const gl::Device& used) {
  base::print("GL devices (choose with --device N, part of a name, or software)\n");
  for (const gl::DeviceEntry& device : devices)
    base::print("  {}  {:<12} {}\n", device.index, device.names.platform,
                device.problem.empty() ? device.names.renderer : "not usable: " + device.problem);
  base::print("\nIn use\n  {}, {}\n  OpenGL {}, through EGL {}\n\n", used.names().renderer,
              used.names().vendor, used.names().version, used.names().platform);
  base::print("Limits, and what they mean here\n");
  for (const Fact& fact : facts(used.limits()))
    base::print("  {:<24} {:>9}  {}\n", fact.name, fact.shown, fact.consequence);
}

}  // namespace

int info(const InfoOptions& options) {
  const auto devices = gl::listDevices();
  const gl::Device used({.choice = options.device.device, .shaderDir = options.device.shaderDir});
  if (options.json)
    base::printResult(base::jsonText(toJson(devices, used)));
  else
    print(devices, used);
  return 0;
}

}  // namespace sfumato::app
