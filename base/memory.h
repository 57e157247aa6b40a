// The memory of this machine.
#pragma once

#include <cstdint>
#include <optional>

namespace sfumato::base {

// What may still be taken, in bytes, when the system says.
std::optional<uint64_t> freeMemory();

}  // namespace sfumato::base
