#include "lists/stress/verification.h"

#include <fmt/format.h>

#include <bit>
#include <tuple>

namespace sfumato::lists::stress {

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
  if (found.good()) return;
  const std::lock_guard lock(mutex_);
  findings_.twice += found.twice;
  findings_.foreign += found.foreign;
  findings_.unsorted += found.unsorted;
  findings_.torn += found.torn;
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
