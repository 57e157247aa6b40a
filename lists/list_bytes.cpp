#include "lists/list_bytes.h"

#include <cstdint>
#include <numeric>

#include "shaders/shared/lists.h"

namespace sfumato::lists {
namespace {

constexpr size_t constantBytes = sizeof(shared::ListCounters) + LIST_TALLIES * sizeof(uint32_t) +
                                 sizeof(shared::ListWindow) + sizeof(shared::ListStep);
constexpr size_t smallestBuffers = 11 * 16;  // a buffer has at least 16 bytes

bool linked(Strategy strategy) {
  return strategy != Strategy::Count;
}

}  // namespace

size_t scanBlocks(size_t count) {
  return (count + LIST_SCAN_BLOCK - 1) / LIST_SCAN_BLOCK;
}

std::vector<size_t> scanLevels(size_t cells) {
  std::vector<size_t> levels = {scanBlocks(cells)};
  while (levels.back() > LIST_SCAN_BLOCK) levels.push_back(scanBlocks(levels.back()));
  return levels;
}

size_t bytesOfCells(Strategy strategy, size_t cells) {
  // Half of them may be listed for the sort.
  const size_t perCell =
      sizeof(shared::ListRun) + sizeof(uint32_t) / 2 + (linked(strategy) ? 2 * sizeof(uint32_t) : 0);
  const std::vector<size_t> levels = scanLevels(cells);
  return cells * perCell + std::accumulate(levels.begin(), levels.end(), size_t{0}) * sizeof(uint32_t);
}

size_t bytesOfNode(Strategy strategy, size_t payloadBytes) {
  return sizeof(shared::ListKey) + payloadBytes +
         (linked(strategy) ? sizeof(shared::ListLink) + payloadBytes : 0);
}

size_t bytesOfLists(Strategy strategy, size_t cells, size_t nodes, size_t payloadBytes) {
  const size_t sorted = nodes / (LIST_SHORT_RUN_IN_BANKS + 1);
  const size_t reserved = linked(strategy) ? sizeof(shared::ListLink) + payloadBytes : 0;
  return constantBytes + bytesOfCells(strategy, cells) + nodes * bytesOfNode(strategy, payloadBytes) +
         reserved + sorted * sizeof(uint32_t) + smallestBuffers;
}

}  // namespace sfumato::lists
