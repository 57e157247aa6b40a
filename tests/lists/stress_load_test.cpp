// The loads of `sfumato stress` have the shapes that they are named for, and what judges the lists sees
// faults.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "base/error.h"
#include "lists/stress/load.h"
#include "lists/stress/verification.h"

namespace sfumato::lists::stress {
namespace {

constexpr Distribution all[] = {Distribution::Uniform, Distribution::HotSpot, Distribution::OneCell,
                                Distribution::Hair};

TEST(StressLoad, HasAsManyNodesAsItSays) {
  for (const Distribution distribution : all) {
    const Load load{.width = 48, .height = 32, .layers = 5, .distribution = distribution};
    const std::vector<uint32_t> lengths = lengthsOf(load);
    EXPECT_EQ(std::accumulate(lengths.begin(), lengths.end(), size_t{0}), load.nodes());
  }
}

TEST(StressLoad, HasTheShapeOfItsName) {
  Load load{.width = 64, .height = 64, .layers = 8};
  EXPECT_EQ(lengthsOf(load), std::vector<uint32_t>(64 * 64, 8));

  load.distribution = Distribution::OneCell;
  const std::vector<uint32_t> one = lengthsOf(load);
  EXPECT_EQ(*std::max_element(one.begin(), one.end()), 8u * 64u);
  EXPECT_EQ(std::count(one.begin(), one.end(), 0u), 64 * 64 - 1);

  load.distribution = Distribution::HotSpot;
  const std::vector<uint32_t> spot = lengthsOf(load);
  EXPECT_GT(*std::max_element(spot.begin(), spot.end()), 10u * 8u);
  EXPECT_LT(std::count(spot.begin(), spot.end(), 0u), 64 * 64 / 10);  // the rest is everywhere

  load.distribution = Distribution::Hair;
  const std::vector<uint32_t> hair = lengthsOf(load);
  EXPECT_GT(std::count(hair.begin(), hair.end(), 0u), 64 * 64 / 10);  // gaps between the strands
  for (int x = 0; x < 64; ++x) {                                      // every strand crosses every column
    uint32_t column = 0;
    for (int y = 0; y < 64; ++y) column += hair[static_cast<size_t>(y * 64 + x)];
    EXPECT_EQ(column, 8u * 64u);
  }
}

TEST(StressLoad, FindsTheNodesOfABlockOfCells) {
  for (const Distribution distribution : all) {
    const Load load{.width = 20, .height = 9, .layers = 6, .distribution = distribution};
    const NumbersByBlock index = numbersByBlock(load);
    ASSERT_EQ(index.firsts.size(), 4u);  // 180 cells are 3 blocks of 64
    EXPECT_EQ(index.firsts.back(), load.nodes());
    std::vector<uint32_t> numbers = index.numbers;
    std::sort(numbers.begin(), numbers.end());
    for (uint32_t i = 0; i < load.nodes(); ++i) ASSERT_EQ(numbers[i], i);
    for (size_t block = 0; block < 3; ++block)
      for (size_t i = index.firsts[block]; i < index.firsts[block + 1]; ++i)
        ASSERT_EQ(nodeOf(load, index.numbers[i]).cell / 64, block);
  }
}

TEST(StressLoad, StaysWithinItsCellsAndDepths) {
  for (const Distribution distribution : all)
    for (const auto& [width, height] : {std::pair(1, 1), {1, 7}, {9, 1}, {16384, 2}, {3, 16384}}) {
      const Load load{.width = width, .height = height, .layers = 2, .distribution = distribution};
      for (uint32_t i = 0; i < load.nodes(); ++i) {
        const Node node = nodeOf(load, i);
        ASSERT_LT(node.cell, load.cells());
        ASSERT_GT(node.depth, 0.f);
        ASSERT_LE(node.depth, 1.f);
      }
    }
}

TEST(StressLoad, ChangesWithTheSeed) {
  for (const Distribution distribution : {Distribution::HotSpot, Distribution::OneCell, Distribution::Hair}) {
    Load load{.distribution = distribution, .seed = 1};
    const std::vector<uint32_t> first = lengthsOf(load);
    EXPECT_EQ(lengthsOf(load), first);
    load.seed = 2;
    EXPECT_NE(lengthsOf(load), first);
  }
}

TEST(StressLoad, IsNamed) {
  for (const Distribution distribution : all)
    EXPECT_EQ(distributions().named(distributions().nameOf(distribution)), distribution);
  EXPECT_THROW(distributions().named("gaussian"), base::Error);
}

// Lists as a device without a fault would build them, for a test to break.
struct Built {
  std::vector<std::vector<NodeKey>> nodes;
  std::vector<std::vector<uint32_t>> payloads;

  explicit Built(const Load& load) : nodes(load.cells()), payloads(load.cells()) {
    for (uint32_t i = 0; i < load.nodes(); ++i) {
      const Node node = nodeOf(load, i);
      nodes[node.cell].push_back({node.depth, i});
    }
    for (size_t cell = 0; cell < nodes.size(); ++cell) {
      std::sort(nodes[cell].begin(), nodes[cell].end(), [](const NodeKey& a, const NodeKey& b) {
        return std::pair(a.depth, a.id) < std::pair(b.depth, b.id);
      });
      for (const NodeKey& node : nodes[cell])
        for (uint32_t word = 0; word < load.payloadWords; ++word)
          payloads[cell].push_back(payloadWord(load, node.id, word));
    }
  }

  Findings judgedBy(const Load& load) const {
    Verification verification(load);
    for (uint32_t cell = 0; cell < nodes.size(); ++cell)
      verification.addCell(cell, nodes[cell], payloads[cell]);
    return verification.findings();
  }
};

constexpr Load smallLoad{
    .width = 16, .height = 8, .layers = 6, .distribution = Distribution::Hair, .payloadWords = 2};

// The first cell with at least `count` nodes.
size_t cellWith(const Built& built, size_t count) {
  for (size_t cell = 0; cell < built.nodes.size(); ++cell)
    if (built.nodes[cell].size() >= count) return cell;
  ADD_FAILURE() << "no such cell";
  return 0;
}

TEST(StressVerification, FindsNothingWrongWithRightLists) {
  for (const Distribution distribution : all)
    for (const uint32_t words : {0u, 1u, 3u}) {
      const Load load{
          .width = 16, .height = 16, .layers = 4, .distribution = distribution, .payloadWords = words};
      const Findings findings = Built(load).judgedBy(load);
      EXPECT_TRUE(findings.good()) << findings.fault;
      EXPECT_EQ(findings.fault, "");
    }
}

TEST(StressVerification, FindsEachFaultAndOnlyThat) {
  const Built right(smallLoad);
  const size_t cell = cellWith(right, 3);

  Built lost = right;
  lost.nodes[cell].pop_back();
  EXPECT_EQ(lost.judgedBy(smallLoad).lost, 1u);
  EXPECT_NE(lost.judgedBy(smallLoad).fault.find("1 of 768 nodes"), std::string::npos);

  Built twice = right;
  twice.nodes[cell].push_back(twice.nodes[cell].back());
  twice.payloads[cell].insert(twice.payloads[cell].end(), twice.payloads[cell].end() - 2,
                              twice.payloads[cell].end());
  EXPECT_EQ(twice.judgedBy(smallLoad).twice, 1u);
  EXPECT_EQ(twice.judgedBy(smallLoad).lost, 0u);

  Built unsorted = right;
  std::swap(unsorted.nodes[cell][0], unsorted.nodes[cell][1]);
  for (int word = 0; word < 2; ++word)
    std::swap(unsorted.payloads[cell][word], unsorted.payloads[cell][word + 2]);
  const Findings unsortedFindings = unsorted.judgedBy(smallLoad);
  EXPECT_EQ(unsortedFindings.unsorted, 1u);
  EXPECT_EQ(unsortedFindings.lost + unsortedFindings.torn, 0u);

  Built torn = right;
  torn.payloads[cell][3] ^= 1u;
  EXPECT_EQ(torn.judgedBy(smallLoad).torn, 1u);
  EXPECT_EQ(torn.judgedBy(smallLoad).lost, 0u);

  Built elsewhere = right;
  auto& other = elsewhere.nodes[cell == 0 ? 1 : 0];
  other.insert(other.begin(), elsewhere.nodes[cell].front());
  elsewhere.payloads[cell == 0 ? 1 : 0].insert(elsewhere.payloads[cell == 0 ? 1 : 0].begin(), 2, 0u);
  EXPECT_EQ(elsewhere.judgedBy(smallLoad).foreign, 1u);
  EXPECT_EQ(elsewhere.judgedBy(smallLoad).lost, 0u);  // it is in its own cell as well

  Built invented = right;
  invented.nodes[cell][1].id = 4000000000u;
  EXPECT_EQ(invented.judgedBy(smallLoad).foreign, 1u);
  EXPECT_EQ(invented.judgedBy(smallLoad).lost, 1u);

  Built deeper = right;
  deeper.nodes[cell][0].depth *= 0.999f;
  EXPECT_EQ(deeper.judgedBy(smallLoad).foreign, 1u);
}

TEST(StressVerification, NamesTheFirstCellThatIsWrong) {
  Built built(smallLoad);
  const size_t cell = cellWith(built, 2);
  for (size_t later = cell; later < built.nodes.size(); ++later)
    if (built.nodes[later].size() >= 2) built.nodes[later][1].id = 4000000000u;
  const std::string fault = built.judgedBy(smallLoad).fault;
  EXPECT_TRUE(fault.starts_with("cell " + std::to_string(cell) + ": node 1 of ")) << fault;
  EXPECT_NE(fault.find("was never inserted"), std::string::npos) << fault;
}

}  // namespace
}  // namespace sfumato::lists::stress
