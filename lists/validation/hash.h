// The hash of shaders/lists/validation/random.glsl, for what the CPU expects.
#pragma once

#include <cstdint>

namespace sfumato::lists::validation {

inline uint32_t hash(uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  return x ^ x >> 16;
}

}  // namespace sfumato::lists::validation
