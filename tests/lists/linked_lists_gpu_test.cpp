#include "lists/linked_lists_gpu.h"

#include <algorithm>

#include "base/error.h"
#include "gl/commands.h"
#include "gl/program.h"
#include "lists/verify.h"
#include "shaders/shared/bindings.h"
#include "tests/gl/test_device.h"

namespace sfumato::lists {
namespace {

struct Load {
  uint32_t nodes;
  uint32_t cells;
  uint32_t depths;  // distinct ones
  uint32_t seed;
};

uint32_t hash(uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  return x ^ x >> 16;
}

class LinkedListsGpu : public tests::GpuTest {
 protected:
  struct Built {
    ListStatistics statistics;
    ListCheck check;
    std::vector<std::vector<uint32_t>> cells;  // payloads in list order
  };

  Built build(const Load& load, size_t expectedNodes, const gl::ShaderDefines& defines = {}) {
    LinkedLists lists(device(), "test lists", load.cells, sizeof(uint32_t), expectedNodes);
    gl::Buffer params(device(), "test params", sizeof load);
    params.writeValue(load);
    const gl::Program& program = device().program({"lists/insert_hashed.comp"}, defines);
    Built built;
    built.statistics = lists.build(device(), [&] {
      params.bindUniform(UNIFORM_PASS);
      gl::dispatchLinear(program, load.nodes);
    });
    const auto heads = lists.readHeads();
    const auto links = lists.readLinks();
    built.check = checkLists(heads, links);
    if (!built.check.fault.empty()) return built;
    const auto payloads = lists.payloads().readValues<uint32_t>(links.size());
    for (const uint32_t head : heads) {
      auto& cell = built.cells.emplace_back();
      for (uint32_t node = head; node != 0; node = links[node].next) cell.push_back(payloads[node]);
    }
    return built;
  }

  // The same lists on the CPU.
  static std::vector<std::vector<uint32_t>> expected(const Load& load) {
    std::vector<std::vector<uint32_t>> cells(load.cells);
    for (uint32_t i = 0; i < load.nodes; ++i) cells[hash(i + load.seed) % load.cells].push_back(i);
    const auto depth = [&](uint32_t i) { return hash(i * 3u + load.seed) % load.depths; };
    for (auto& cell : cells)
      std::sort(cell.begin(), cell.end(),
                [&](uint32_t a, uint32_t b) { return std::pair(depth(a), a) < std::pair(depth(b), b); });
    return cells;
  }
};

constexpr Load crowded{20000, 64, 100, 1};  // many equal depths, contention on every lock
constexpr Load sparse{50000, 40000, 1u << 24, 2};

TEST_F(LinkedListsGpu, HoldsEveryNodeOnceAndSortedUnderContention) {
  for (const Load& load : {crowded, sparse, Load{500, 1, 7, 3}, Load{1, 1, 1, 4}}) {
    const Built built = build(load, load.nodes);
    ASSERT_EQ(built.check.fault, "");
    EXPECT_EQ(built.check.nodes, built.statistics.demand);
    EXPECT_EQ(built.statistics.demand, load.nodes);
    EXPECT_EQ(built.statistics.builds, 1);
    EXPECT_EQ(built.cells, expected(load));
  }
}

TEST_F(LinkedListsGpu, GrowsToTheDemandAndBuildsAgain) {
  const Built built = build(crowded, 10);
  ASSERT_EQ(built.check.fault, "");
  EXPECT_EQ(built.statistics.builds, 2);
  EXPECT_GE(built.statistics.capacity, crowded.nodes);
  EXPECT_EQ(built.cells, expected(crowded));
}

TEST_F(LinkedListsGpu, MergesWhatABoundedSpinOrWalkSentToTheOverflowList) {
  // Bounds so low that most nodes take the fallback.
  const Built built = build(crowded, crowded.nodes, {{"LIST_SPIN_LIMIT", "1"}, {"LIST_WALK_LIMIT", "3"}});
  ASSERT_EQ(built.check.fault, "");
  EXPECT_GT(built.statistics.overflowed, crowded.nodes / 4);
  EXPECT_EQ(built.cells, expected(crowded));
}

TEST_F(LinkedListsGpu, TheChecksSeeLossesWithoutTheLock) {
  const Built built = build(crowded, crowded.nodes, {{"WITHOUT_LOCK", "1"}});
  const bool caught = !built.check.fault.empty() || built.check.nodes < built.statistics.demand;
  EXPECT_TRUE(caught) << "no update was lost without the lock: this device cannot show that the lock works";
}

TEST_F(LinkedListsGpu, SaysWhatItWouldTakeWhenTheDeviceCannotHoldIt) {
  LinkedLists lists(device(), "test lists", 4, 4, 16);
  const auto draw = [&] {
    // A demand that was counted, of nodes that no pool holds.
    const shared::ListCounters counters{.demand = 4000000000u, .overflowed = 0, .unmerged = 0, .maxSpins = 0};
    lists.countersForTest().writeValue(counters);
  };
  EXPECT_FALSE(lists.tryBuild(device(), 4, draw).has_value());
  try {
    lists.build(device(), draw);
    FAIL() << "no error";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.exitCode, base::ExitCode::Memory);
    EXPECT_NE(std::string(error.what()).find("61035.2 MiB"), std::string::npos) << error.what();
  }
}

TEST(CheckLists, FindsEachFault) {
  const std::vector<shared::ListLink> links = {
      {0, 0, 0}, {1.f, 0, 2}, {2.f, 0, 0}, {0.5f, 0, 1}, {9.f, 0, 4}};
  EXPECT_EQ(checkLists(std::vector<uint32_t>{3}, links).fault, "");
  EXPECT_EQ(checkLists(std::vector<uint32_t>{3}, links).nodes, 3u);
  EXPECT_NE(checkLists(std::vector<uint32_t>{1, 3}, links).fault, "");  // shared node
  EXPECT_NE(checkLists(std::vector<uint32_t>{4}, links).fault, "");     // cycle
  EXPECT_NE(checkLists(std::vector<uint32_t>{7}, links).fault, "");     // outside the pool
  const std::vector<shared::ListLink> unsorted = {{0, 0, 0}, {3.f, 0, 2}, {2.f, 0, 0}};
  EXPECT_NE(checkLists(std::vector<uint32_t>{1}, unsorted).fault, "");
}

}  // namespace
}  // namespace sfumato::lists
