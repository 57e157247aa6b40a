// Seeded random numbers that are the same on every machine: PCG32 (O'Neill 2014), and a hash of integers.
#pragma once

#include <cstdint>

namespace sfumato::base {

class Random {
 public:
  explicit Random(uint64_t seed) {
    next();
    state_ += seed;
    next();
  }

  // A 32-bit integer, uniform.
  uint32_t next() {
    const uint64_t old = state_;
    state_ = old * 6364136223846793005ull + 1442695040888963407ull;
    const auto shifted = static_cast<uint32_t>(((old >> 18) ^ old) >> 27);
    const auto rotation = static_cast<uint32_t>(old >> 59);
    return (shifted >> rotation) | (shifted << ((32 - rotation) & 31));
  }

  // A number in [0, 1).
  double uniform() { return next() * 0x1p-32; }
  // A number in [low, high).
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

 private:
  uint64_t state_ = 0;
};

}  // namespace sfumato::base
