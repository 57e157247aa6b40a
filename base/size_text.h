// Numbers of bytes, as people read and write them.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <string>
#include <string_view>

namespace sfumato::base {

// In the largest unit of which there is one: "96 bytes", "12.5 KiB", "3.2 MiB", "1.5 GiB".
inline std::string sizeText(double bytes) {
  if (bytes < 1024) return fmt::format("{:.0f} bytes", bytes);
  const char* const units[] = {"KiB", "MiB", "GiB"};
  size_t unit = 0;
  for (bytes /= 1024; bytes >= 1023.95 && unit < 2; bytes /= 1024) ++unit;
  return fmt::format("{:.1f} {}", bytes, units[unit]);
}

template <typename Integer>
std::string sizeText(Integer bytes) {
  return sizeText(static_cast<double>(bytes));
}

// "268435456", "256K", "256M", "2G", in powers of 1024. Throws Usage, naming `flag`, for anything else.
size_t bytesNamed(std::string_view text, std::string_view flag);

}  // namespace sfumato::base
