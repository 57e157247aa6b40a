// The values of an enum by the names that users give them.
#pragma once

#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/error.h"

namespace sfumato::base {

template <typename Value>
struct Choice {
  std::string flag;                // of the command line, for errors
  std::vector<std::string> names;  // in the enum's order

  const std::string& nameOf(Value value) const { return names[static_cast<size_t>(value)]; }

  // Throws Usage for another name.
  Value named(const std::string& name) const {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
      fail(ExitCode::Usage, "{} {}: unknown: choose {} or {}", flag, name,
           fmt::join(names.begin(), names.end() - 1, ", "), names.back());
    return static_cast<Value>(found - names.begin());
  }
};

}  // namespace sfumato::base
