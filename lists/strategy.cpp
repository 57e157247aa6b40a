#include "lists/strategy.h"

#include <algorithm>

#include "base/error.h"

namespace sfumato::lists {
namespace {

template <typename Value>
Value valueNamed(std::string_view name, const std::vector<std::string>& names, std::string_view flag) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    base::fail(base::ExitCode::Usage, "{} {}: unknown: choose {}", flag, name, fmt::join(names, ", "));
  return static_cast<Value>(found - names.begin());
}

}  // namespace

const std::vector<std::string>& strategyNames() {
  static const std::vector<std::string> names = {"spinlock", "lockfree", "append", "count"};
  return names;
}

const std::vector<std::string>& onOverflowNames() {
  static const std::vector<std::string> names = {"grow", "window", "error"};
  return names;
}

const std::string& nameOf(Strategy strategy) {
  return strategyNames()[static_cast<size_t>(strategy)];
}

const std::string& nameOf(OnOverflow policy) {
  return onOverflowNames()[static_cast<size_t>(policy)];
}

Strategy strategyNamed(std::string_view name) {
  return valueNamed<Strategy>(name, strategyNames(), "--lists");
}

OnOverflow onOverflowNamed(std::string_view name) {
  return valueNamed<OnOverflow>(name, onOverflowNames(), "--on-overflow");
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
