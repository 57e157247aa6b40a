#include "lists/lists_gpu.h"

#include <algorithm>
#include <numeric>

#include "base/error.h"
#include "base/hash.h"
#include "gl/commands.h"
#include "gl/program.h"
#include "shaders/shared/bindings.h"
#include "tests/gl/test_device.h"

namespace sfumato::lists {
namespace {

using base::hash;

constexpr Strategy strategies[] = {Strategy::SpinLock, Strategy::LockFree, Strategy::Append, Strategy::Count};

struct Load {
  uint32_t nodes;
  uint32_t cells;
  uint32_t depths;  // distinct ones
  uint32_t seed;
};

// In which order, and in how many draws, the nodes are stored: node = factor * i + offset.
struct Order {
  uint32_t factor = 1;  // no divisor of the number of nodes
  uint32_t offset = 0;
  uint32_t draws = 1;
};

struct Params {
  Load load;
  uint32_t factor, offset, first, count;
};

// Node numbers of every cell, sorted by (depth, number).
using Cells = std::vector<std::vector<uint32_t>>;

uint32_t cellOf(const Load& load, uint32_t node) {
  return hash(node + load.seed) % load.cells;
}

float depthOf(const Load& load, uint32_t node) {
  return static_cast<float>(hash(node * 3u + load.seed) % load.depths) - 2.f;
}

Cells listsOnTheCpu(const Load& load) {
  Cells cells(load.cells);
  for (uint32_t i = 0; i < load.nodes; ++i) cells[cellOf(load, i)].push_back(i);
  for (auto& cell : cells)
    std::sort(cell.begin(), cell.end(), [&](uint32_t a, uint32_t b) {
      return std::pair(depthOf(load, a), a) < std::pair(depthOf(load, b), b);
    });
  return cells;
}

class ListsGpu : public tests::GpuTest {
 protected:
  Draw drawOf(const Load& load, int payloadWords, const Order& order = {}, gl::ShaderDefines more = {}) {
    params_ = gl::Buffer(device(), "test params", sizeof(Params));
    return [=, this](const Pass& pass) {
      gl::ShaderDefines defines = pass.defines;
      defines.emplace_back("PAYLOAD", std::to_string(payloadWords));
      defines.insert(defines.end(), more.begin(), more.end());
      const gl::Program& program = device().program({"lists/store_hashed.comp"}, defines);
      const uint32_t share = (load.nodes + order.draws - 1) / order.draws;
      for (uint32_t first = 0; first < load.nodes && share > 0; first += share) {
        params_.writeValue(
            Params{load, order.factor, order.offset, first, std::min(share, load.nodes - first)});
        params_.bindUniform(UNIFORM_PASS);
        gl::dispatchLinear(program, share);
      }
    };
  }

  // The runs that were built last, with every key and payload checked.
  Cells read(const Lists& lists, const Load& load, int payloadWords) {
    const auto runs = lists.readRuns();
    const auto keys = lists.readKeys();
    const auto payloads = lists.readPayloads();
    const auto words = static_cast<size_t>(payloadWords);
    Cells cells;
    size_t wrong = 0;
    for (const shared::ListRun& run : runs) {
      auto& cell = cells.emplace_back();
      for (size_t i = run.first; i < size_t{run.first} + run.count && i < keys.size(); ++i) {
        const uint32_t node = keys[i].id;
        cell.push_back(node);
        wrong += keys[i].depth != depthOf(load, node);
        const uint32_t expected[] = {node, 2 * node, ~node};
        for (size_t word = 0; word < words; ++word) wrong += payloads[i * words + word] != expected[word];
      }
    }
    EXPECT_EQ(wrong, 0u);
    return cells;
  }

  Cells build(const Load& load, int payloadWords, const ListOptions& options, const Order& order = {},
              const gl::ShaderDefines& more = {}) {
    Lists lists(device(), "test lists", load.cells, static_cast<size_t>(payloadWords) * 4, options);
    statistics_ = lists.build(device(), drawOf(load, payloadWords, order, more));
    return read(lists, load, payloadWords);
  }

  // The cells of all windows, one after the other.
  Cells buildWindows(const Load& load, int payloadWords, const ListOptions& options,
                     const std::string& label = "test lists") {
    Lists lists(device(), label, load.cells, static_cast<size_t>(payloadWords) * 4, options);
    Cells cells;
    statistics_ = lists.buildWindows(device(), drawOf(load, payloadWords), [&](const Window& window) {
      EXPECT_EQ(window.firstCell, cells.size());
      const Cells part = read(lists, load, payloadWords);
      EXPECT_EQ(window.cells, part.size());
      cells.insert(cells.end(), part.begin(), part.end());
    });
    return cells;
  }

  gl::Buffer params_;
  ListStatistics statistics_;
};

constexpr Load crowded{20000, 64, 100, 1};  // many equal depths, long runs
constexpr Load sparse{50000, 40000, 1u << 24, 2};
constexpr Load mixed{60001, 5000, 50, 7};  // runs of 3 to 30
constexpr Load oneCell{500, 1, 7, 3};
constexpr Load oneNode{1, 1, 1, 4};

TEST_F(ListsGpu, EveryStrategyGivesTheListsOfTheCpuWhateverTheOrderOfDraws) {
  for (const Load& load : {crowded, sparse, mixed, oneCell, oneNode}) {
    const Cells expected = listsOnTheCpu(load);
    for (const Strategy strategy : strategies) {
      for (const int words : {0, 1, 3}) {
        for (const Order& order : {Order{}, Order{7919, 13, 5}}) {
          ASSERT_EQ(build(load, words, {.strategy = strategy}, order), expected)
              << lists::strategies().nameOf(strategy) << ", " << load.nodes << " nodes, " << words
              << " words";
          EXPECT_EQ(statistics_.strategy, strategy);
          EXPECT_EQ(statistics_.distrusted, 0);
          EXPECT_EQ(statistics_.demand, load.nodes);
          EXPECT_EQ(statistics_.stored, load.nodes);
          EXPECT_EQ(statistics_.predicted, load.nodes);
          EXPECT_EQ(statistics_.builds, 2);
        }
      }
    }
  }
}

TEST_F(ListsGpu, EveryStrategyKeepsEveryNodeOfLongLists) {
  for (const Strategy strategy : strategies) {
    for (const Load& load : {Load{512, 1, 40, 5}, Load{100000, 1, 1u << 20, 6}}) {
      ASSERT_EQ(build(load, 1, {.strategy = strategy}), listsOnTheCpu(load))
          << lists::strategies().nameOf(strategy);
      EXPECT_EQ(statistics_.distrusted, 0);
      EXPECT_EQ(statistics_.longest, load.nodes);
    }
  }
}

TEST_F(ListsGpu, WhatABoundedLoopGivesUpIsInItsRunAllTheSame) {
  for (const Strategy strategy : {Strategy::SpinLock, Strategy::LockFree}) {
    // Bounds so low that most nodes take the fallback.
    const Cells cells =
        build(crowded, 1, {.strategy = strategy}, {}, {{"LIST_SPIN_LIMIT", "1"}, {"LIST_WALK_LIMIT", "3"}});
    EXPECT_EQ(cells, listsOnTheCpu(crowded));
    EXPECT_GT(statistics_.overflowed, crowded.nodes / 4);
    EXPECT_EQ(statistics_.distrusted, 0);
  }
}

TEST_F(ListsGpu, AStrategyThatLosesNodesIsFoundOutAndReplaced) {
  // Without the lock updates are lost; `count` then does the build again.
  EXPECT_EQ(build(crowded, 1, {.strategy = Strategy::SpinLock}, {}, {{"WITHOUT_LOCK", "1"}}),
            listsOnTheCpu(crowded));
  EXPECT_EQ(statistics_.strategy, Strategy::Count) << "no update was lost without the lock: this device "
                                                      "cannot show that the lock works";
  EXPECT_EQ(statistics_.distrusted, 1);
  // Nor is `count` believed when its second draw stores other nodes than the first one counted.
  EXPECT_EQ(build(crowded, 1, {}, {}, {{"ELSEWHERE_WHEN_SCATTERED", "1"}}), listsOnTheCpu(crowded));
  EXPECT_EQ(statistics_.strategy, Strategy::Append);
  EXPECT_EQ(statistics_.distrusted, 1);
}

TEST_F(ListsGpu, StatisticsAreExact) {
  const Cells expected = listsOnTheCpu(mixed);
  std::array<size_t, lengthClasses> lengths{};
  size_t longest = 0;
  for (const auto& cell : expected) {
    size_t length = 0;
    while (length < 2 ? length < cell.size() : cell.size() > size_t{1} << (length - 1)) ++length;
    ++lengths[length];
    longest = std::max(longest, cell.size());
  }
  for (const Strategy strategy : strategies) {
    build(mixed, 1, {.strategy = strategy});
    EXPECT_EQ(statistics_.lengths, lengths);
    EXPECT_EQ(statistics_.longest, longest);
    EXPECT_EQ(statistics_.cells, mixed.cells);
    EXPECT_EQ(statistics_.windows, 1);
    EXPECT_EQ(statistics_.nodeBytes, 12u);
    EXPECT_GE(statistics_.capacity, mixed.nodes);
    EXPECT_GE(statistics_.predictedBytes, statistics_.bytes * 9 / 10);
    EXPECT_EQ(statistics_.maxSpins >= 1, strategy != Strategy::Count);
    EXPECT_LE(statistics_.p99Spins, 2 * statistics_.maxSpins);
  }
}

TEST_F(ListsGpu, PredictsBeforeANodeIsStored) {
  Lists lists(device(), "predicted lists", mixed.cells, 4);
  EXPECT_EQ(lists.predict(device(), mixed.cells, drawOf(mixed, 1)), mixed.nodes);
  EXPECT_LT(device().memory().peakBytesByLabel().at("predicted lists"), mixed.nodes * 4);
}

TEST_F(ListsGpu, ABudgetHoldsAndNothingIsLost) {
  for (const Strategy strategy : strategies) {
    build(mixed, 1, {.strategy = strategy});
    const size_t demand = statistics_.bytes;
    for (const size_t percent : {100u, 60u, 25u, 10u}) {
      const std::string label = fmt::format("{} {} %", lists::strategies().nameOf(strategy), percent);
      const ListOptions options{.strategy = strategy, .budgetBytes = demand * percent / 100};
      ASSERT_EQ(buildWindows(mixed, 1, options, label), listsOnTheCpu(mixed)) << label;
      EXPECT_EQ(statistics_.stored, mixed.nodes);
      EXPECT_EQ(statistics_.demand, mixed.nodes);
      EXPECT_EQ(statistics_.cells, mixed.cells);
      EXPECT_LE(statistics_.bytes, options.budgetBytes) << label;
      // What the ledger of the device saw, whatever the lists say of themselves.
      EXPECT_LE(device().memory().peakBytesByLabel().at(label), options.budgetBytes) << label;
      EXPECT_GE(statistics_.windows, static_cast<int>(100 / percent)) << label;
    }
  }
}

TEST_F(ListsGpu, ABudgetIsOfEmptyCellsAsWell) {
  const Load nothing{0, 20000, 1, 1};
  for (const Strategy strategy : strategies) {
    Lists lists(device(), "empty lists", nothing.cells, 4, {.strategy = strategy, .budgetBytes = 50000});
    EXPECT_FALSE(lists.tryBuild(device(), nothing.cells, drawOf(nothing, 1)));
    EXPECT_GT(lists.fitting(), 1000u);
    const auto fitted = lists.tryBuild(device(), lists.fitting(), drawOf(nothing, 1));
    ASSERT_TRUE(fitted);
    EXPECT_LE(fitted->bytes, 50000u);
    EXPECT_LE(lists.buildWindows(device(), drawOf(nothing, 1), [](const Window&) {}).bytes, 50000u);
  }
}

TEST_F(ListsGpu, ABudgetDownToOneNodeHolds) {
  const Load load{40, 200, 10, 9};  // no cell has more than a few
  const Cells expected = listsOnTheCpu(load);
  const size_t longest = std::max_element(expected.begin(), expected.end(), [](const auto& a, const auto& b) {
                           return a.size() < b.size();
                         })->size();
  for (const Strategy strategy : strategies) {
    // The smallest budget with which no cell is an error.
    size_t least = 0;
    for (size_t budget = 400; least == 0 && budget < 4000; budget += 20) {
      try {
        EXPECT_EQ(buildWindows(load, 1, {.strategy = strategy, .budgetBytes = budget}), expected);
        least = budget;
      } catch (const base::Error& error) {
        EXPECT_EQ(error.exitCode, base::ExitCode::Memory);
        EXPECT_NE(std::string(error.what()).find("one cell alone holds"), std::string::npos);
      }
    }
    EXPECT_GT(least, 0u) << lists::strategies().nameOf(strategy);
    EXPECT_LE(statistics_.capacity, 2 * longest) << lists::strategies().nameOf(strategy);
  }
}

TEST_F(ListsGpu, PoliciesDoWhatTheySay) {
  for (const Strategy strategy : strategies) {
    const Load load = crowded;
    const size_t budget = 100000;
    // Grow: past the budget.
    EXPECT_EQ(build(load, 1, {.strategy = strategy, .budgetBytes = budget, .onOverflow = OnOverflow::Grow}),
              listsOnTheCpu(load));
    EXPECT_GT(statistics_.bytes, budget);
    // Window: a build at once is refused, and told how many cells fit.
    Lists lists(device(), "test lists", load.cells, 4, {.strategy = strategy, .budgetBytes = budget});
    EXPECT_FALSE(lists.tryBuild(device(), load.cells, drawOf(load, 1)));
    EXPECT_GT(lists.fitting(), 0u);
    EXPECT_LT(lists.fitting(), load.cells);
    const size_t fitting = lists.fitting();
    EXPECT_TRUE(lists.tryBuild(device(), fitting, drawOf(load, 1)));
    EXPECT_FALSE(lists.tryBuild(device(), fitting + 1, drawOf(load, 1)));
    // Error: says how much it takes.
    try {
      build(load, 1, {.strategy = strategy, .budgetBytes = budget, .onOverflow = OnOverflow::Error});
      FAIL() << "no error";
    } catch (const base::Error& error) {
      EXPECT_EQ(error.exitCode, base::ExitCode::Memory);
      EXPECT_NE(std::string(error.what()).find("20000 nodes"), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("--list-memory"), std::string::npos) << error.what();
    }
  }
}

TEST_F(ListsGpu, OneCellOverTheBudgetIsAnErrorThatSaysHowMuch) {
  for (const Strategy strategy : strategies) {
    try {
      buildWindows(oneCell, 3, {.strategy = strategy, .budgetBytes = 5000});
      FAIL() << "no error";
    } catch (const base::Error& error) {
      EXPECT_EQ(error.exitCode, base::ExitCode::Memory);
      EXPECT_NE(std::string(error.what()).find("one cell alone holds 500 nodes"), std::string::npos)
          << error.what();
    }
  }
}

TEST_F(ListsGpu, PoolsOfSeveralBanksHoldTheSame) {
  for (const Strategy strategy : strategies)
    for (const int words : strategy == Strategy::Count ? std::vector{0, 3} : std::vector{1})
      for (const Load& load : {mixed, crowded}) {
        // Two to four banks.
        const size_t bytes = size_t{load.nodes} * 12 / 2;
        ASSERT_EQ(build(load, words, {.strategy = strategy, .bankBytes = bytes}), listsOnTheCpu(load))
            << lists::strategies().nameOf(strategy) << ", " << words << " words";
        EXPECT_EQ(statistics_.distrusted, 0);
      }
}

TEST_F(ListsGpu, MoreThanAllBanksHoldIsBuiltInWindows) {
  for (const Strategy strategy : strategies) {
    const ListOptions options{.strategy = strategy, .bankBytes = 12 * 2048};
    EXPECT_THROW(build(mixed, 1, options), base::Error);
    ASSERT_EQ(buildWindows(mixed, 1, options), listsOnTheCpu(mixed)) << lists::strategies().nameOf(strategy);
    EXPECT_GT(statistics_.windows, 7);
  }
}

TEST_F(ListsGpu, AContainerIsBuiltAgainAndAgain) {
  for (const Strategy strategy : strategies) {
    Lists lists(device(), "test lists", mixed.cells, 4, {.strategy = strategy});
    for (const Load& load : {Load{100, mixed.cells, 50, 1}, mixed, Load{0, mixed.cells, 1, 1}, mixed}) {
      EXPECT_EQ(lists.build(device(), drawOf(load, 1)).stored, load.nodes);
      ASSERT_EQ(read(lists, load, 1), listsOnTheCpu(load));
    }
  }
}

}  // namespace
}  // namespace sfumato::lists
