// What judges lists of unknown nodes against a log of them: each fault is seen, and told from the others.
#include "lists/stress/comparison.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace sfumato::lists::stress {
namespace {

using shared::ListKey;
using shared::ListLogEntry;
using shared::ListRun;

// Three cells with 3, 0 and 2 nodes, two words of payload each, as they should be.
struct Lists {
  std::vector<ListRun> runs = {{0, 3}, {3, 0}, {3, 2}};
  std::vector<ListKey> keys = {{-1.f, 7}, {0.f, 4}, {0.5f, 4}, {2.f, 1}, {2.f, 3}};
  std::vector<uint32_t> payloads = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
  LoggedNodes log = {.entries = {{2, 2.f, 3}, {0, 0.5f, 4}, {0, -1.f, 7}, {2, 2.f, 1}, {0, -0.f, 4}},
                     .payloads = {9, 10, 5, 6, 1, 2, 7, 8, 3, 4}};

  Findings compared() const { return compare({runs, keys, payloads, 2, 10}, log); }
};

TEST(StressComparison, FindsNothingWrongWithRightLists) {
  const Findings findings = Lists().compared();
  EXPECT_TRUE(findings.good()) << findings.fault;
  EXPECT_EQ(findings.fault, "");
}

TEST(StressComparison, SeesLostNodes) {
  Lists lists;
  lists.runs[0] = {1, 2};
  EXPECT_EQ(lists.compared().lost, 1u);
  EXPECT_EQ(lists.compared().faults(), 0u);
  EXPECT_EQ(lists.compared().fault, "the list of cell 10, of 2 nodes, lacks nodes that the draws store");
  lists.runs[2] = {0, 0};
  EXPECT_EQ(lists.compared().lost, 3u);
}

TEST(StressComparison, SeesNodesThatNobodyStored) {
  Lists lists;
  lists.log.entries.pop_back();
  EXPECT_EQ(lists.compared().foreign, 1u);
  EXPECT_EQ(lists.compared().lost, 0u);
}

TEST(StressComparison, SeesAChangedDepthIdOrCellAsOneLostAndOneForeign) {
  for (int change = 0; change < 3; ++change) {
    Lists lists;
    if (change == 0) lists.keys[0].depth = -1.5f;
    if (change == 1) lists.keys[0].id = 8;
    if (change == 2) lists.log.entries[2].cell = 1;
    EXPECT_EQ(lists.compared().lost, 1u);
    EXPECT_EQ(lists.compared().foreign, 1u);
    EXPECT_EQ(lists.compared().faults(), 1u);
  }
}

TEST(StressComparison, SeesNodesThatStandTwice) {
  Lists lists;
  lists.runs[2] = {3, 3};
  lists.keys.push_back(lists.keys[4]);
  lists.payloads.insert(lists.payloads.end(), {9, 10});
  EXPECT_EQ(lists.compared().twice, 1u);
  EXPECT_EQ(lists.compared().foreign, 0u);
  // Also where the draws store it twice.
  lists.log.entries.push_back(lists.log.entries[0]);
  lists.log.payloads.insert(lists.log.payloads.end(), {9, 10});
  EXPECT_EQ(lists.compared().twice, 1u);
  EXPECT_EQ(lists.compared().lost, 0u);
}

TEST(StressComparison, TakesPartsOfOnePrimitiveThatDifferInTheirPayload) {
  Lists lists;
  lists.keys[3].id = 3;
  lists.log.entries[3].id = 3;
  EXPECT_TRUE(lists.compared().good());
}

TEST(StressComparison, SeesTornPayloads) {
  Lists lists;
  lists.payloads[5] = 0;
  EXPECT_EQ(lists.compared().torn, 1u);
  EXPECT_EQ(lists.compared().lost, 0u);
  EXPECT_EQ(lists.compared().faults(), 1u);
}

TEST(StressComparison, SeesListsThatDoNotAscend) {
  for (const auto& [a, b] : {std::pair(0, 1), {1, 2}, {3, 4}}) {
    Lists lists;
    std::swap(lists.keys[static_cast<size_t>(a)], lists.keys[static_cast<size_t>(b)]);
    for (int word = 0; word < 2; ++word)
      std::swap(lists.payloads[static_cast<size_t>(2 * a + word)],
                lists.payloads[static_cast<size_t>(2 * b + word)]);
    EXPECT_EQ(lists.compared().unsorted, 1u);
    EXPECT_EQ(lists.compared().lost, 0u);
    EXPECT_EQ(lists.compared().faults(), 1u);
  }
}

TEST(StressComparison, SeesRunsThatLeaveThePool) {
  Lists lists;
  lists.runs[2] = {4, 2};
  EXPECT_EQ(lists.compared().broken, 1u);
  EXPECT_EQ(lists.compared().lost, 2u);
  lists.runs[2] = {4000000000u, 4000000000u};
  EXPECT_EQ(lists.compared().broken, 1u);
}

TEST(StressComparison, TakesDepthsOfEveryBitPattern) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  Lists lists;
  lists.keys[4].depth = nan;
  lists.log.entries[0].depth = nan;
  EXPECT_TRUE(lists.compared().good()) << lists.compared().fault;
}

}  // namespace
}  // namespace sfumato::lists::stress
