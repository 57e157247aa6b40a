// Checks lists that were read back from the GPU, node by node.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "shaders/shared/lists.h"

namespace sfumato::lists {

struct ListCheck {
  size_t nodes = 0;    // nodes reached from the heads
  size_t longest = 0;  // nodes of the longest list
  std::string fault;   // empty, or the first fault found, in words
};

// Walks every list: each node index is inside the pool, reached once (so no cycle and no sharing), and each
// list is strictly ascending by (depth, id).
ListCheck checkLists(std::span<const uint32_t> heads, std::span<const shared::ListLink> links);

}  // namespace sfumato::lists
