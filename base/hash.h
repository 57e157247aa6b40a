// A hash of 32 bits, the same on every machine. shaders/shared/hash.glsl has it for the GPU.
#pragma once

#include <cstdint>

namespace sfumato::base {

// A bijection with little bias (Wellons 2018, "lowbias32").
constexpr uint32_t hash(uint32_t x) {
  x = (x ^ x >> 16) * 0x7feb352du;
  x = (x ^ x >> 15) * 0x846ca68bu;
  return x ^ x >> 16;
}

}  // namespace sfumato::base
