#include "lists/verify.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <vector>

namespace sfumato::lists {

ListCheck checkLists(std::span<const uint32_t> heads, std::span<const shared::ListLink> links) {
  ListCheck result;
  std::vector<bool> reached(links.size(), false);
  for (size_t cell = 0; cell < heads.size(); ++cell) {
    size_t length = 0;
    uint32_t previous = 0;
    for (uint32_t node = heads[cell]; node != 0; node = links[node].next) {
      if (node >= links.size()) {
        result.fault = fmt::format("cell {}: node {} is outside the pool of {}", cell, node, links.size());
        return result;
      }
      if (reached[node]) {
        result.fault = fmt::format("cell {}: node {} is reached twice", cell, node);
        return result;
      }
      const auto key = [&](uint32_t n) { return std::tuple(links[n].depth, links[n].id); };
      if (previous != 0 && !(key(previous) < key(node))) {
        result.fault = fmt::format("cell {}: node {} does not sort after node {}", cell, node, previous);
        return result;
      }
      reached[node] = true;
      previous = node;
      ++length;
    }
    result.nodes += length;
    result.longest = std::max(result.longest, length);
  }
  return result;
}

}  // namespace sfumato::lists
