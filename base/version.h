#pragma once

namespace sfumato::base {

// The program's version, as in CMakeLists.txt: "0.1.0".
const char* version();

}  // namespace sfumato::base
