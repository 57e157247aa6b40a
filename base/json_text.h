// JSON as text.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace sfumato::base {

// With a line for each value, or all in one where `indent` is -1, and a line's end; bytes that are no UTF-8,
// which a driver's names may have, are replaced.
template <typename Json>
std::string jsonText(const Json& json, int indent = 2) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace sfumato::base
