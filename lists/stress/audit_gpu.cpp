#include "lists/stress/audit_gpu.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>

#include "base/parallel.h"
#include "gl/commands.h"
#include "shaders/shared/bindings.h"

namespace sfumato::lists::stress {

using shared::ListCounters;
using shared::ListLogEntry;
using shared::ListWindow;

namespace {

double secondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// How many of the runs' cells, from `first` on, have no more nodes than that; at least one.
size_t cellsHolding(std::span<const shared::ListRun> runs, size_t first, size_t nodes) {
  size_t cells = 0;
  for (size_t sum = 0; first + cells < runs.size(); ++cells) {
    sum += runs[first + cells].count;
    if (sum > nodes && cells > 0) break;
  }
  return cells;
}

}  // namespace

void Audit::built(gl::Device& device, const Lists& lists, const Window& window, const Draw& draw) {
  const gl::Profiler::Scope time(device.profiler(), "audit");
  const std::vector<shared::ListRun> runs = lists.readRuns();
  const std::vector<shared::ListKey> keys = lists.readKeys();
  const std::vector<uint32_t> payloads = lists.readPayloads();
  Audited& audited = audited_[lists.label()];
  if (audited.lengths.empty())
    for (const shared::ListRun& run : runs) audited.lengths.push_back(run.count);

  // A log is one storage block.
  const size_t entryBytes = std::max(sizeof(ListLogEntry), lists.payloadBytes());
  const size_t most = static_cast<size_t>(device.limits().storageBlockBytes) / entryBytes / 2;
  for (size_t first = 0; first < runs.size();) {
    const size_t cells = cellsHolding(runs, first, most);
    const ReadLists read{.runs = std::span(runs).subspan(first, cells),
                         .keys = keys,
                         .payloads = payloads,
                         .payloadWords = lists.payloadBytes() / sizeof(uint32_t),
                         .firstCell = window.firstCell + first};
    size_t nodes = 0;
    for (const shared::ListRun& run : read.runs) nodes += run.count;
    const LoggedNodes logged = log(device, lists.payloadBytes(), {read.firstCell, cells}, draw, nodes);
    audited.findings += compare(read, logged);
    first += cells;
  }
  lookUp(device, lists, window,
         {.runs = runs, .keys = keys, .payloads = payloads, .firstCell = window.firstCell}, audited);
}

// `expected`: nodes that there will be, if the lists are right.
LoggedNodes Audit::log(gl::Device& device, size_t payloadBytes, const Window& window, const Draw& draw,
                       size_t expected) {
  gl::Buffer counters(device, "audit", sizeof(ListCounters) + LIST_TALLIES * sizeof(uint32_t));
  gl::Buffer windowBlock(device, "audit", sizeof(ListWindow));
  for (size_t capacity = expected;;) {
    gl::Buffer entries(device, "audit", capacity * sizeof(ListLogEntry));
    gl::Buffer payloads(device, "audit", capacity * payloadBytes);
    counters.clear();
    windowBlock.writeValue(ListWindow{
        {static_cast<int>(window.firstCell), static_cast<int>(window.cells), static_cast<int>(capacity), 0}});
    windowBlock.bindUniform(UNIFORM_LISTS);
    counters.bindStorage(STORAGE_LIST_COUNTERS);
    entries.bindStorage(STORAGE_LIST_NODES);
    payloads.bindStorage(STORAGE_LIST_PAYLOADS);
    draw({{{"LIST_PASS", "LIST_PASS_LOG"}}, window});
    gl::storageBarrier();
    const size_t demand = counters.readValue<ListCounters>().demand;
    if (demand <= capacity)
      return {entries.readValues<ListLogEntry>(demand),
              payloads.readValues<uint32_t>(demand * payloadBytes / sizeof(uint32_t))};
    capacity = demand;
  }
}

// Twice: the second time without what a device does at the first.
void Audit::lookUp(gl::Device& device, const Lists& lists, const Window& window, const ReadLists& read,
                   Audited& audited) const {
  float farthest = 0;
  for (const shared::ListKey& key : read.keys)
    if (std::isfinite(key.depth)) farthest = std::max(farthest, key.depth);
  std::vector<uint32_t> sums;
  for (int i = 0; i < 2; ++i) {
    const auto start = std::chrono::steady_clock::now();
    sums = stress::lookUp(device, lists, window, farthest, "audit check");
    if (i == 1) audited.lookupSeconds += secondsSince(start);
  }
  audited.lookups += window.cells * lookupsPerCell;
  std::atomic<size_t> misread = 0;
  base::parallelFor(static_cast<long>(read.runs.size()), [&](long cell) {
    const shared::ListRun& run = read.runs[static_cast<size_t>(cell)];
    if (size_t{run.first} + run.count > read.keys.size()) return;
    uint32_t sum = 0;
    for (uint32_t i = 0; i < run.count; ++i) sum += lookupsThatFind(read.keys[run.first + i].depth, farthest);
    if (sum != sums[static_cast<size_t>(cell)]) ++misread;
  });
  audited.findings.misread += misread;
  if (misread > 0 && audited.findings.fault.empty())
    audited.findings.fault = fmt::format("a shader's lookups find other nodes in {} lists", misread.load());
}

}  // namespace sfumato::lists::stress
