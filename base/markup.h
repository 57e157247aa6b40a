// Text for HTML and XML.
#pragma once

#include <string>
#include <string_view>

namespace sfumato::base {

// The text with what markup takes for its own written as entities; fit for elements and quoted attributes.
inline std::string escapedForMarkup(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else if (c == '"')
      result += "&quot;";
    else
      result += c;
  }
  return result;
}

}  // namespace sfumato::base
