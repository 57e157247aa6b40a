// Networks of comparisons that sort whatever they are given (Batcher 1968), as text for
// shaders/lists/sort.comp.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace sfumato::lists {

// Elements first < second that are put in order, one pair after the other.
using Network = std::vector<std::pair<int, int>>;

// Sorts `size` elements, a power of 2: odd-even merge sort.
Network sortingNetwork(int size);
// Sorts `size` elements of which the first ascend and the rest descend, or the other way round: a bitonic
// merge.
Network mergingNetwork(int size);

std::string networkText(const Network& network);  // "S(0,1) S(2,3) ..."
std::string elementsText(int size);               // "E(0) E(1) ..."

}  // namespace sfumato::lists
