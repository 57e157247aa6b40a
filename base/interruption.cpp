#include "base/interruption.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "base/error.h"

namespace sfumato::base {
namespace {

// A handler is told nothing but its signal: the pipe that it writes to stands here.
int readEnd = -1;
volatile std::sig_atomic_t writeEnd = -1;

void note(int) {
  const int before = errno;
  const char byte = 0;
  [[maybe_unused]] const auto written = write(writeEnd, &byte, 1);
  errno = before;
}

}  // namespace

Interruption::Interruption(std::initializer_list<int> signals) {
  check(readEnd < 0, "interruptions are listened for in one place");
  int ends[2];
  if (pipe2(ends, O_CLOEXEC | O_NONBLOCK) != 0)
    fail(ExitCode::Bug, "no pipe to note an interruption: {}", std::strerror(errno));
  readEnd = ends[0];
  writeEnd = ends[1];
  struct sigaction action {};
  action.sa_handler = note;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  for (const int signal : signals) sigaction(signal, &action, &before_.emplace_back(signal, action).second);
}

Interruption::~Interruption() {
  for (const auto& [signal, action] : before_) sigaction(signal, &action, nullptr);
  close(std::exchange(readEnd, -1));
  close(writeEnd);
  writeEnd = -1;
}

bool Interruption::happened() const {
  pollfd polled{readEnd, POLLIN, 0};
  return poll(&polled, 1, 0) > 0;
}

int Interruption::stream() const {
  return readEnd;
}

}  // namespace sfumato::base
