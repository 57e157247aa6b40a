#include "lists/stress/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <compare>
#include <mutex>
#include <numeric>

#include "base/parallel.h"

namespace sfumato::lists::stress {
namespace {

// A node where it stands, in a list or in the log.
struct PlacedNode {
  int32_t rank;  // of its depth among all depths: see shaders/lists/order.glsl
  uint32_t id;
  const uint32_t* payload;
};

int32_t rankOf(float depth) {
  const auto bits = std::bit_cast<int32_t>(depth == 0 ? 0.f : depth);
  return bits < 0 ? bits ^ 0x7fffffff : bits;
}

class Comparison {
 public:
  Comparison(const ReadLists& lists, const LoggedNodes& log) : lists_(lists), log_(log) {
    // The log's entries by cell.
    firsts_.resize(lists.runs.size() + 1);
    for (const shared::ListLogEntry& entry : log.entries) ++firsts_[entry.cell + 1];
    std::partial_sum(firsts_.begin(), firsts_.end(), firsts_.begin());
    std::vector<size_t> next(firsts_.begin(), firsts_.end() - 1);
    ofCells_.resize(log.entries.size());
    for (size_t i = 0; i < log.entries.size(); ++i) ofCells_[next[log.entries[i].cell]++] = i;
  }

  Findings findings() {
    base::parallelFor(static_cast<long>(lists_.runs.size()),
                      [&](long cell) { compareCell(static_cast<size_t>(cell)); });
    return findings_;
  }

 private:
  std::strong_ordering order(const PlacedNode& a, const PlacedNode& b, bool payloads) const {
    if (const auto depths = a.rank <=> b.rank; depths != 0) return depths;
    if (const auto ids = a.id <=> b.id; ids != 0 || !payloads) return ids;
    return std::lexicographical_compare_three_way(a.payload, a.payload + lists_.payloadWords, b.payload,
                                                  b.payload + lists_.payloadWords);
  }
  void sort(std::vector<PlacedNode>& nodes) const {
    std::sort(nodes.begin(), nodes.end(),
              [&](const PlacedNode& a, const PlacedNode& b) { return order(a, b, true) < 0; });
  }

  std::vector<PlacedNode> listed(const shared::ListRun& run) const {
    std::vector<PlacedNode> nodes;
    for (size_t i = run.first; i < size_t{run.first} + run.count; ++i)
      nodes.push_back({rankOf(lists_.keys[i].depth), lists_.keys[i].id, payload(lists_.payloads, i)});
    return nodes;
  }
  std::vector<PlacedNode> logged(size_t cell) const {
    std::vector<PlacedNode> nodes;
    for (size_t i = firsts_[cell]; i < firsts_[cell + 1]; ++i) {
      const shared::ListLogEntry& entry = log_.entries[ofCells_[i]];
      nodes.push_back({rankOf(entry.depth), entry.id, payload(log_.payloads, ofCells_[i])});
    }
    return nodes;
  }
  const uint32_t* payload(std::span<const uint32_t> words, size_t node) const {
    return words.data() + node * lists_.payloadWords;
  }

  void compareCell(size_t cell) {
    const shared::ListRun& run = lists_.runs[cell];
    if (size_t{run.first} + run.count > lists_.keys.size()) {
      add(cell, {.lost = firsts_[cell + 1] - firsts_[cell], .broken = 1}, "is not within the pool");
      return;
    }
    Findings found;
    std::vector<PlacedNode> nodes = listed(run);
    for (size_t i = 1; i < nodes.size(); ++i)
      if (order(nodes[i - 1], nodes[i], false) > 0) ++found.unsorted;
    std::vector<PlacedNode> expected = logged(cell);
    sort(nodes);
    sort(expected);
    for (size_t i = 1; i < nodes.size(); ++i)
      if (order(nodes[i - 1], nodes[i], true) == 0) ++found.twice;
    merge(expected, nodes, found);
    if (!found.good()) add(cell, found, faultOf(found));
  }

  // Both ascend.
  void merge(const std::vector<PlacedNode>& expected, const std::vector<PlacedNode>& nodes,
             Findings& found) const {
    size_t e = 0, n = 0;
    while (e < expected.size() || n < nodes.size()) {
      const bool missing =
          n == nodes.size() || (e < expected.size() && order(expected[e], nodes[n], false) < 0);
      const bool surplus =
          e == expected.size() || (n < nodes.size() && order(expected[e], nodes[n], false) > 0);
      if (missing) {
        ++found.lost;
        ++e;
      } else if (surplus) {
        const bool again = n > 0 && order(nodes[n - 1], nodes[n], true) == 0;  // is counted already
        if (!again) ++found.foreign;
        ++n;
      } else {
        if (order(expected[e], nodes[n], true) != 0) ++found.torn;
        ++e;
        ++n;
      }
    }
  }

  static const char* faultOf(const Findings& found) {
    if (found.lost > 0) return "lacks nodes that the draws store";
    if (found.twice > 0) return "has a node twice";
    if (found.foreign > 0) return "has nodes that no draw stores there";
    return found.torn > 0 ? "has other payloads than the draws store" : "does not ascend";
  }

  void add(size_t cell, const Findings& found, const char* fault) {
    const std::lock_guard lock(mutex_);
    findings_ += found;
    if (cell >= faultyCell_) return;
    faultyCell_ = cell;
    findings_.fault = fmt::format("the list of cell {}, of {} nodes, {}", lists_.firstCell + cell,
                                  lists_.runs[cell].count, fault);
  }

  const ReadLists& lists_;
  const LoggedNodes& log_;
  std::vector<size_t> firsts_;   // of each cell, and the end
  std::vector<size_t> ofCells_;  // numbers of entries
  std::mutex mutex_;
  Findings findings_;
  size_t faultyCell_ = SIZE_MAX;
};

}  // namespace

Findings compare(const ReadLists& lists, const LoggedNodes& log) {
  return Comparison(lists, log).findings();
}

}  // namespace sfumato::lists::stress
