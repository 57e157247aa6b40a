// Tables for a terminal.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace sfumato::app {

using Row = std::vector<std::string>;

// A line for each row, all of the first one's length; words to the left, numbers to the right. `words`: the
// columns that hold words, from the first on.
std::string aligned(const std::vector<Row>& rows, size_t words);

}  // namespace sfumato::app
