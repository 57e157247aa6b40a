// Checks of the lists that the engine itself builds, with its own shaders, in each of its strategies.
#include <fmt/format.h>

#include <algorithm>

#include "base/hash.h"
#include "gl/commands.h"
#include "lists/lists_gpu.h"
#include "lists/validation/probe_gpu.h"

namespace sfumato::lists::validation {
namespace {

using base::hash;

// Fragments of all tiles and invocations of all workgroups meet in each cell.
struct Load {
  int side;
  uint32_t layers;
  uint32_t cells;
  uint32_t seed;

  static constexpr uint32_t depths = 100;
  uint32_t fragments() const { return static_cast<uint32_t>(side * side) * layers; }
  uint32_t items() const { return 2 * fragments(); }
  uint32_t cellOf(uint32_t item) const { return hash(item + seed) % cells; }
  float depthOf(uint32_t item) const { return static_cast<float>(hash(item * 3 + seed) % depths); }
};

Load loadOf(const Context& context) {
  const bool full = context.scale == Scale::Full;
  return {full ? 256 : 96, full ? 4u : 2u, full ? 4096u : 512u, static_cast<uint32_t>(context.seed)};
}

gl::ShaderDefines definesOf(const Load& load) {
  return {{"SIDE", fmt::format("{}u", load.side)},
          {"COUNT", fmt::format("{}u", load.fragments())},
          {"FRAGMENTS", fmt::format("{}u", load.fragments())},
          {"CELLS", fmt::format("{}u", load.cells)},
          {"DEPTHS", fmt::format("{}u", Load::depths)},
          {"SEED", fmt::format("{}u", load.seed)}};
}

// The first half of the items by fragments, the other by a dispatch.
void store(const Context& context, const Load& load, const Pass& pass) {
  const gl::ShaderDefines defines = gl::joined(pass.defines, definesOf(load));
  drawLayers(context.device, probeProgram(context, {"layers.vert", "engine.frag"}, defines), load.side,
             load.layers);
  gl::dispatchLinear(probeProgram(context, {"engine.comp"}, defines), load.fragments());
}

std::vector<std::vector<uint32_t>> expectedCells(const Load& load) {
  std::vector<std::vector<uint32_t>> cells(load.cells);
  for (uint32_t item = 0; item < load.items(); ++item) cells[load.cellOf(item)].push_back(item);
  for (auto& cell : cells)
    std::sort(cell.begin(), cell.end(), [&](uint32_t a, uint32_t b) {
      return std::pair(load.depthOf(a), a) < std::pair(load.depthOf(b), b);
    });
  return cells;
}

// Cells whose run is not what it should be, node by node.
int64_t wrongCells(const Load& load, const Lists& lists) {
  const auto runs = lists.readRuns();
  const auto keys = lists.readKeys();
  const auto payloads = lists.readPayloads();
  const auto expected = expectedCells(load);
  int64_t wrong = 0;
  for (size_t cell = 0; cell < load.cells; ++cell) {
    const shared::ListRun run = cell < runs.size() ? runs[cell] : shared::ListRun{0, 0};
    bool right = run.count == expected[cell].size() && size_t{run.first} + run.count <= keys.size();
    for (size_t i = 0; right && i < run.count; ++i) {
      const uint32_t item = expected[cell][i];
      right = keys[run.first + i].id == item && keys[run.first + i].depth == load.depthOf(item) &&
              payloads[run.first + i] == ~item;
    }
    wrong += right ? 0 : 1;
  }
  return wrong;
}

// The same load on lists that are pushed to without atomics: what it loses shows that there is contention.
int64_t lostWithoutAtomics(const Context& context, const Load& load) {
  const gl::ShaderDefines defines = {{"ADDRESSES", fmt::format("{}u", load.cells)},
                                     {"COUNT", fmt::format("{}u", load.items())},
                                     {"CAPACITY", "0u"},
                                     {"SEED", fmt::format("{}u", load.seed)},
                                     {"WITHOUT_ATOMIC", "1"}};
  const gl::Buffer counters = zeroWords(context.device, load.cells);
  const gl::Buffer nothing = zeroWords(context.device, 1);
  const gl::Buffer outcome = zeroWords(context.device, 1);
  counters.bindStorage(0);
  nothing.bindStorage(1);
  outcome.bindStorage(2);
  gl::dispatchLinear(probeProgram(context, {"ticket.comp"}, defines), load.items());
  gl::storageBarrier();
  int64_t kept = 0;
  for (const uint32_t count : counters.readValues<uint32_t>(load.cells)) kept += count;
  return load.items() - kept;
}

Result engineLists(const Context& context, Strategy strategy) {
  const Load load = loadOf(context);
  Lists lists(context.device, "validation lists", load.cells, sizeof(uint32_t), {.strategy = strategy});
  const ListStatistics statistics =
      lists.build(context.device, [&](const Pass& pass) { store(context, load, pass); });
  const int64_t wrong = wrongCells(load, lists);
  Result result;
  result.figures = {{"nodes", int64_t{load.items()}},
                    {"cells", int64_t{load.cells}},
                    {"longest list", static_cast<int64_t>(statistics.longest)},
                    {"retries", static_cast<int64_t>(statistics.retries)},
                    {"most tries of one insertion", static_cast<int64_t>(statistics.maxSpins)},
                    {"nodes by the fallback", static_cast<int64_t>(statistics.overflowed)},
                    {"wrong cells", wrong},
                    {"builds that lost nodes", int64_t{statistics.distrusted}}};
  if (wrong != 0 || statistics.distrusted != 0) {
    result.verdict = Verdict::Fail;
    result.finding = wrong != 0 ? fmt::format("{} of {} cells are wrong", wrong, load.cells)
                                : "the build lost nodes, and was done again by counting";
    result.meaning =
        fmt::format("the engine must not build lists by `{}` on this driver", strategies().nameOf(strategy));
    return result;
  }
  const int64_t lost = lostWithoutAtomics(context, load);
  result.figures.emplace_back("updates lost without atomics", lost);
  if (lost == 0) {
    result.verdict = Verdict::NoPower;
    result.finding = "without atomics the same load loses nothing either";
  }
  return result;
}

}  // namespace

std::vector<Check> engineChecks() {
  std::vector<Check> checks;
  for (const Strategy strategy : {Strategy::SpinLock, Strategy::LockFree, Strategy::Append, Strategy::Count})
    checks.push_back({.name = "engine-" + strategies().nameOf(strategy),
                      .group = "engine",
                      .does = "the engine's own lists by `" + strategies().nameOf(strategy) +
                              "`: every cell, node by node",
                      .strategies = {strategies().nameOf(strategy)},
                      .run = [strategy](const Context& context) { return engineLists(context, strategy); }});
  return checks;
}

}  // namespace sfumato::lists::validation
