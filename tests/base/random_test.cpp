#include "base/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace sfumato::base {
namespace {

// PCG32 as its paper has it (XSH-RR, increment 1442695040888963407), written with wider integers than the
// class.
uint32_t pcgOutput(uint64_t state) {
  const uint32_t xored = static_cast<uint32_t>((((state >> 18) ^ state) >> 27) & 0xffffffffu);
  const unsigned turn = static_cast<unsigned>(state >> 59);
  return static_cast<uint32_t>((((static_cast<uint64_t>(xored) << 32) | xored) >> turn) & 0xffffffffu);
}

uint64_t pcgStep(uint64_t state) {
  return static_cast<uint64_t>(static_cast<unsigned __int128>(state) * 6364136223846793005ull +
                               1442695040888963407ull);
}

TEST(Random, IsPcg32) {
  for (const uint64_t seed : {0ull, 1ull, 42ull, ~0ull}) {
    uint64_t state = pcgStep(pcgStep(0) + seed);
    Random random(seed);
    for (int i = 0; i < 100; ++i, state = pcgStep(state)) ASSERT_EQ(random.next(), pcgOutput(state));
  }
}

TEST(Random, IsTheSameForOneSeedAndAnotherForAnother) {
  Random first(7), again(7), other(8);
  int equal = 0;
  for (int i = 0; i < 1000; ++i) {
    const uint32_t number = first.next();
    ASSERT_EQ(number, again.next());
    equal += number == other.next();
  }
  EXPECT_LT(equal, 2);
}

TEST(Random, IsUniform) {
  Random random(3);
  constexpr int count = 100'000;
  double sum = 0, squares = 0, low = 10, high = -10;
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(-2, 4);
    sum += x;
    squares += x * x;
    low = std::min(low, x);
    high = std::max(high, x);
  }
  const double mean = sum / count, variance = squares / count - mean * mean;
  EXPECT_GE(low, -2);
  EXPECT_LT(high, 4);
  EXPECT_LT(low, -1.99);
  EXPECT_GT(high, 3.99);
  EXPECT_NEAR(mean, 1, 5 * std::sqrt(3.0 / count));  // five standard errors
  EXPECT_NEAR(variance, 3, 0.05);
}

}  // namespace
}  // namespace sfumato::base
