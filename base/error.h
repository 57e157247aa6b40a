// The one exception type. It is thrown at setup and at the file edges, never inside a frame, and reaches the
// user as one line: place, what is wrong, what to do.
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace sfumato::base {

// What the program returns to the shell.
enum class ExitCode {
  Done = 0,
  CheckFailed = 1,  // a comparison or a verdict is bad
  Usage = 2,        // the command line is wrong
  Input = 3,        // an input file is missing, damaged or unsupported; an output cannot be written
  NoGl = 4,         // no usable OpenGL
  Memory = 5,       // over a memory budget or a limit of the device
  Bug = 6,          // ours
};

class Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& line) : std::runtime_error(line), exitCode(code) {}
  const ExitCode exitCode;
};

// Throws an Error whose line is formatted as by fmt::format.
template <typename... Args>
[[noreturn]] void fail(ExitCode code, fmt::format_string<Args...> format, Args&&... args) {
  throw Error(code, fmt::format(format, std::forward<Args>(args)...));
}

// Throws an Error of code Bug unless `holds`: for what only a fault of ours can break.
inline void check(bool holds, const char* what) {
  if (!holds) fail(ExitCode::Bug, "internal check failed: {}: please report it", what);
}

}  // namespace sfumato::base
