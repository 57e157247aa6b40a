#include "lists/strategy.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/error.h"
#include "lists/sorting_network.h"

namespace sfumato::lists {
namespace {

TEST(Strategy, NamesAreReadAsTheyAreWritten) {
  for (const Strategy strategy : {Strategy::SpinLock, Strategy::LockFree, Strategy::Append, Strategy::Count})
    EXPECT_EQ(strategies().named(strategies().nameOf(strategy)), strategy);
  for (const OnOverflow policy : {OnOverflow::Grow, OnOverflow::Window, OnOverflow::Error})
    EXPECT_EQ(overflowPolicies().named(overflowPolicies().nameOf(policy)), policy);
  EXPECT_EQ(strategies().nameOf(Strategy::LockFree), "lockfree");
  EXPECT_EQ(overflowPolicies().nameOf(OnOverflow::Error), "error");
  EXPECT_THROW(strategies().named("fast"), base::Error);
  EXPECT_THROW(overflowPolicies().named(""), base::Error);
}

TEST(Strategy, FiguresOfWindowsAreJoined) {
  ListStatistics a{.cells = 3, .demand = 10, .longest = 4, .windows = 1, .bytes = 100};
  a.lengths[2] = 3;
  ListStatistics b{.cells = 5, .demand = 2, .longest = 7, .windows = 1, .bytes = 50};
  b.lengths[2] = 4;
  a += b;
  EXPECT_EQ(a.cells, 8u);
  EXPECT_EQ(a.demand, 12u);
  EXPECT_EQ(a.longest, 7u);
  EXPECT_EQ(a.windows, 2);
  EXPECT_EQ(a.bytes, 100u);
  EXPECT_EQ(a.lengths[2], 7u);
}

bool sorts(const Network& network, std::vector<int> values) {
  for (const auto& [first, second] : network)
    if (values[static_cast<size_t>(second)] < values[static_cast<size_t>(first)])
      std::swap(values[static_cast<size_t>(first)], values[static_cast<size_t>(second)]);
  return std::is_sorted(values.begin(), values.end());
}

// A network that sorts every sequence of zeros and ones sorts everything (Knuth, volume 3, 5.3.4).
TEST(SortingNetwork, SortsEverySequenceOfZerosAndOnes) {
  for (const int size : {1, 2, 4, 8, 16}) {
    const Network network = sortingNetwork(size);
    for (uint32_t bits = 0; bits < 1u << size; ++bits) {
      std::vector<int> values;
      for (int i = 0; i < size; ++i) values.push_back(static_cast<int>(bits >> i & 1u));
      ASSERT_TRUE(sorts(network, values)) << size << ", " << bits;
    }
  }
  EXPECT_EQ(sortingNetwork(8).size(), 19u);  // Batcher's counts
  EXPECT_EQ(sortingNetwork(32).size(), 191u);
  Network broken = sortingNetwork(8);
  broken.erase(broken.begin() + 7);
  bool all = true;
  for (uint32_t bits = 0; bits < 256; ++bits) {
    std::vector<int> values;
    for (int i = 0; i < 8; ++i) values.push_back(static_cast<int>(bits >> i & 1u));
    all = all && sorts(broken, values);
  }
  EXPECT_FALSE(all);
}

TEST(SortingNetwork, MergesEverythingBitonic) {
  for (const int size : {2, 8, 32})
    for (int rise = 0; rise <= size; ++rise)
      for (int fall = rise; fall <= size; ++fall) {
        std::vector<int> up, down;
        for (int i = 0; i < size; ++i) {
          up.push_back(i >= rise && i < fall ? 1 : 0);
          down.push_back(1 - up.back());
        }
        ASSERT_TRUE(sorts(mergingNetwork(size), up)) << size << ", " << rise << ", " << fall;
        ASSERT_TRUE(sorts(mergingNetwork(size), down)) << size << ", " << rise << ", " << fall;
      }
}

}  // namespace
}  // namespace sfumato::lists
