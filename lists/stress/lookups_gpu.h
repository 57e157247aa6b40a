// Lookups in finished lists, as a marching ray does them: how many nodes stand at or before each of some
// depths that only grow.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "gl/device.h"
#include "lists/lists_gpu.h"

namespace sfumato::lists::stress {

constexpr uint32_t lookupsPerCell = 64;

// Looks into each of a window's runs at multiples of `farthest` / 64; gives the sum of what each cell's
// lookups find. The dispatch is a pass "lookup" of the profiler, reading back one of the name `reading`.
std::vector<uint32_t> lookUp(gl::Device& device, const Lists& lists, const Window& window, float farthest,
                             const std::string& reading);

// Those of a cell's lookups that find a node of this depth, on the CPU.
uint32_t lookupsThatFind(float depth, float farthest);

}  // namespace sfumato::lists::stress
