// Judges finished lists of which nothing is known in advance, node by node against a log of what was stored
// in them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lists/stress/verification.h"
#include "shaders/shared/lists.h"

namespace sfumato::lists::stress {

// The cells [firstCell, firstCell + runs.size()) of a container, as read back.
struct ReadLists {
  std::span<const shared::ListRun> runs;
  std::span<const shared::ListKey> keys;
  std::span<const uint32_t> payloads;  // payloadWords of each key, in a row
  size_t payloadWords = 0;
  size_t firstCell = 0;
};

// Nodes of those cells in any order.
struct LoggedNodes {
  std::vector<shared::ListLogEntry> entries;  // cells count from firstCell
  std::vector<uint32_t> payloads;             // payloadWords of each
};

// Every logged node must be in the list of its cell, once, with its depth, id and payload; nothing else may
// be; and each list must ascend by (depth, id) within the pool. Nodes that are wholly equal count as `twice`,
// logged or not: no draw stores one again. Finds lost, twice, foreign, unsorted, torn and broken ones.
Findings compare(const ReadLists& lists, const LoggedNodes& log);

}  // namespace sfumato::lists::stress
