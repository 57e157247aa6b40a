#include "lists/stress/verification.h"

#include <fmt/format.h>

#include <bit>
#include <tuple>

namespace sfumato::lists::stress {

Findings& Findings::operator+=(const Findings& other) {
  lost += other.lost;
  twice += other.twice;
  foreign += other.foreign;
  unsorted += other.unsorted;
  torn += other.torn;
  broken += other.broken;
  misread += other.misread;
  different += other.different;
  rebuilt += other.rebuilt;
  overwritten += other.overwritten;
  hidden += other.hidden;
  if (fault.empty()) fault = other.fault;
  return *this;
}

Verification::Verification(const Load& load) : load_(load), seen_((load.nodes() + 63) / 64) {}

bool Verification::isFirst(uint32_t number) {
  const uint64_t bit = uint64_t{1} << (number % 64);
  return (seen_[number / 64].fetch_or(bit, std::memory_order_relaxed) & bit) == 0;
}

void Verification::addCell(uint32_t cell, std::span<const NodeKey> nodes,
                           std::span<const uint32_t> payloads) {
  Findings found;
  const auto blame = [&](size_t& kind, size_t at, const char* what) {
    ++kind;
    if (found.fault.empty())
      found.fault = fmt::format("cell {}: node {} of {} (depth {}, id {}) {}", cell, at, nodes.size(),
                                nodes[at].depth, nodes[at].id, what);
  };
  for (size_t i = 0; i < nodes.size(); ++i) {
    const NodeKey& node = nodes[i];
    if (node.id >= load_.nodes()) {
      blame(found.foreign, i, "was never inserted");
      continue;
    }
    const Node expected = nodeOf(load_, node.id);
    if (expected.cell != cell || expected.depth != node.depth) {
      blame(found.foreign, i, "belongs elsewhere");
      continue;
    }
    if (!isFirst(node.id)) blame(found.twice, i, "stands there twice");
    if (i > 0 && std::tuple(nodes[i - 1].depth, nodes[i - 1].id) >= std::tuple(node.depth, node.id))
      blame(found.unsorted, i, "does not sort after the one before it");
    for (uint32_t word = 0; word < load_.payloadWords; ++word)
      if (payloads[i * load_.payloadWords + word] != payloadWord(load_, node.id, word)) {
        blame(found.torn, i, "has another payload");
        break;
      }
  }
  if (!found.good()) add(cell, found);
}

void Verification::addBrokenRun(uint32_t cell, uint32_t first, uint32_t count) {
  add(cell,
      {.broken = 1,
       .fault = fmt::format("cell {}: {} nodes from {} on are not within the pool", cell, count, first)});
}

void Verification::addMisread(uint32_t cell) {
  add(cell, {.misread = 1, .fault = fmt::format("cell {}: a shader's lookups find other nodes in it", cell)});
}

void Verification::add(uint32_t cell, const Findings& found) {
  const std::lock_guard lock(mutex_);
  findings_ += found;
  if (cell < faultyCell_) {
    faultyCell_ = cell;
    findings_.fault = found.fault;
  }
}

Findings Verification::findings() const {
  Findings result = findings_;
  size_t seen = 0;
  for (const auto& word : seen_) seen += static_cast<size_t>(std::popcount(word.load()));
  result.lost = load_.nodes() - seen;
  if (result.lost > 0 && result.fault.empty())
    result.fault = fmt::format("{} of {} nodes are in no list", result.lost, load_.nodes());
  return result;
}

}  // namespace sfumato::lists::stress
