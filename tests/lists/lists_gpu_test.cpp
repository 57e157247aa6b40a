#include "lists/lists_gpu.h"

#include <algorithm>
#include <numeric>

#include "base/error.h"
#include "gl/commands.h"
#include "gl/program.h"
#include "shaders/shared/bindings.h"
#include "tests/gl/test_device.h"

namespace sfumato::lists {
namespace {

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

uint32_t hash(uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  return x ^ x >> 16;
}

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
      for (uint32_t first = 0; first < load.nodes; first += share) {
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
  Cells buildWindows(const Load& load, int payloadWords, const ListOptions& options) {
    Lists lists(device(), "test lists", load.cells, static_cast<size_t>(payloadWords) * 4, options);
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
              << nameOf(strategy) << ", " << load.nodes << " nodes, " << words << " words";
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

}  // namespace
}  // namespace sfumato::lists
