// Names and messages from a file, made fit for a one-line message.
#pragma once

#include <string>
#include <string_view>

namespace sfumato::scene {

// The text with control characters as spaces, without blanks at its ends, cut after about `longest` bytes.
inline std::string printable(std::string_view text, size_t longest = 120) {
  const auto isBlank = [](char c) { return static_cast<unsigned char>(c) <= ' ' || c == '\x7f'; };
  std::string line;
  for (char c : text.substr(0, longest)) line += isBlank(c) ? ' ' : c;
  // A cut must not leave half a UTF-8 character.
  if (text.size() > longest) {
    while (!line.empty() && (static_cast<unsigned char>(line.back()) & 0xc0) == 0x80) line.pop_back();
    if (!line.empty() && (static_cast<unsigned char>(line.back()) & 0x80) != 0) line.pop_back();
    line += "...";
  }
  const size_t first = line.find_first_not_of(' ');
  return first == std::string::npos ? "" : line.substr(first, line.find_last_not_of(' ') - first + 1);
}

}  // namespace sfumato::scene
