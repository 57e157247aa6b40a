#include "base/size_text.h"

#include <charconv>
#include <limits>

#include "base/error.h"

namespace sfumato::base {

size_t bytesNamed(std::string_view text, std::string_view flag) {
  size_t number = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, problem] = std::from_chars(text.data(), end, number);
  const std::string_view unit(rest, static_cast<size_t>(end - rest));
  const size_t units = std::string_view("KMG").find(unit.empty() ? '?' : unit.front());
  const size_t shift = unit.empty() ? 0 : 10 * (units + 1);
  const bool known = unit.empty() || (unit.size() == 1 && units != std::string_view::npos);
  if (problem != std::errc() || !known || number > std::numeric_limits<size_t>::max() >> shift)
    fail(ExitCode::Usage, "{} {}: not a size: write bytes, or 64K, 256M, 2G", flag, text);
  return number << shift;
}

}  // namespace sfumato::base
