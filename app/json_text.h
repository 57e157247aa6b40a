// JSON as the program shows it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace sfumato::app {

// With a line for each value; bytes that are no UTF-8, which a driver's names may have, are replaced.
inline std::string text(const nlohmann::json& json) {
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace sfumato::app
