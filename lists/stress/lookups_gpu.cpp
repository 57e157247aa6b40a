#include "lists/stress/lookups_gpu.h"

#include <algorithm>

#include "gl/buffer.h"
#include "gl/commands.h"
#include "gl/program.h"
#include "shaders/shared/bindings.h"
#include "shaders/shared/stress.h"

namespace sfumato::lists::stress {

using gl::Profiler;

std::vector<uint32_t> lookUp(gl::Device& device, const Lists& lists, const Window& window, float farthest,
                             const std::string& reading) {
  gl::Buffer sums(device, "stress lookups", window.cells * sizeof(uint32_t));
  gl::Buffer params(device, "stress params", sizeof(shared::StressParams));
  params.writeValue(shared::StressParams{
      .window = {static_cast<int>(window.firstCell), static_cast<int>(window.cells), 0, 0},
      .lookups = {farthest, 0.f, 0.f, 0.f}});
  const gl::Program& program =
      device.program({"lists/stress/lookup.comp"}, {{"LOOKUPS", std::to_string(lookupsPerCell) + "u"}});
  {
    const Profiler::Scope time(device.profiler(), "lookup");
    params.bindUniform(UNIFORM_PASS);
    lists.bind(TEXTURE_LIST_RUNS, TEXTURE_LIST_KEYS, TEXTURE_LIST_PAYLOADS);
    sums.bindStorage(STORAGE_COUNTERS);
    gl::dispatchLinear(program, window.cells);
    gl::storageBarrier();
  }
  const Profiler::Scope time(device.profiler(), reading);
  return sums.readValues<uint32_t>(window.cells);
}

uint32_t lookupsThatFind(float depth, float farthest) {
  uint32_t first = 1;  // the first lookup at or behind the depth
  uint32_t end = lookupsPerCell + 1;
  while (first < end) {
    const uint32_t middle = (first + end) / 2;
    if (depth <= farthest * (static_cast<float>(middle) / static_cast<float>(lookupsPerCell)))
      end = middle;
    else
      first = middle + 1;
  }
  return lookupsPerCell + 1 - first;
}

}  // namespace sfumato::lists::stress
