#include "lists/strategy.h"

#include <algorithm>

namespace sfumato::lists {

const base::Choice<Strategy>& strategies() {
  static const base::Choice<Strategy> choice{"--lists", {"spinlock", "lockfree", "append", "count"}};
  return choice;
}

const base::Choice<OnOverflow>& overflowPolicies() {
  static const base::Choice<OnOverflow> choice{"--on-overflow", {"grow", "window", "error"}};
  return choice;
}

ListStatistics& ListStatistics::operator+=(const ListStatistics& other) {
  strategy = other.strategy;
  cells += other.cells;
  demand += other.demand;
  stored += other.stored;
  predicted += other.predicted;
  hidden += other.hidden;
  longest = std::max(longest, other.longest);
  for (size_t i = 0; i < lengths.size(); ++i) lengths[i] += other.lengths[i];
  overflowed += other.overflowed;
  maxSpins = std::max(maxSpins, other.maxSpins);
  p99Spins = std::max(p99Spins, other.p99Spins);
  retries += other.retries;
  windows += other.windows;
  builds += other.builds;
  distrusted += other.distrusted;
  capacity = std::max(capacity, other.capacity);
  nodeBytes = std::max(nodeBytes, other.nodeBytes);
  predictedBytes = std::max(predictedBytes, other.predictedBytes);
  bytes = std::max(bytes, other.bytes);
  return *this;
}

}  // namespace sfumato::lists
