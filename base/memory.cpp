#include "base/memory.h"

#include <fstream>
#include <string>

namespace sfumato::base {

std::optional<uint64_t> freeMemory() {
  std::ifstream file("/proc/meminfo");
  std::string word;
  while (file >> word)
    if (word == "MemAvailable:") {
      uint64_t kibi = 0;
      if (file >> kibi) return kibi * 1024;
    }
  return std::nullopt;
}

}  // namespace sfumato::base
