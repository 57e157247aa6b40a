// What one container of lists takes, by how it is built and what it holds: known before it is there.
#pragma once

#include <cstddef>
#include <vector>

#include "lists/strategy.h"

namespace sfumato::lists {

// Of the scan, to hold so many cells or sums.
size_t scanBlocks(size_t count);
// How many sums each level of the scan over `cells` has, from the lowest to the one that is a single block.
std::vector<size_t> scanLevels(size_t cells);

// Of everything that grows with the cells.
size_t bytesOfCells(Strategy strategy, size_t cells);
// Of everything that grows with the nodes, a node, while they are built.
size_t bytesOfNode(Strategy strategy, size_t payloadBytes);
// Of all its buffers, with a pool of so many nodes.
size_t bytesOfLists(Strategy strategy, size_t cells, size_t nodes, size_t payloadBytes);

}  // namespace sfumato::lists
