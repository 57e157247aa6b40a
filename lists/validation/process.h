// Other programs, run with a time limit, and ended when the user interrupts.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace sfumato::lists::validation {

// How a program ended, and what it wrote.
struct Ended {
  enum class How { Exited, Signalled, TimedOut, Interrupted };
  How how = How::Exited;
  int code = 0;  // the exit code, or the signal's number
  std::string out;
  std::string err;
  double seconds = 0;
};

using Command = std::vector<std::string>;  // the program's path, then its arguments

// Runs the commands in order, up to `jobs` of them at a time, and tells `onEnd` of each (its index in
// `commands`) as it ends. One that takes longer than `timeoutSeconds` is killed. On SIGINT or SIGTERM all
// that run are killed, `onEnd` is told of these too, no more are started, and the result is false. A command
// that cannot be started exits with code 127, as in a shell.
bool runCommands(const std::vector<Command>& commands, int jobs, double timeoutSeconds,
                 const std::function<void(size_t, const Ended&)>& onEnd);

// The path of this program, to be run again.
std::string thisProgram();

}  // namespace sfumato::lists::validation
