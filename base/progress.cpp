#include "base/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "base/log.h"

namespace sfumato::base {

Progress::Progress(std::string what, long total)
    : what_(std::move(what)),
      total_(std::max(total, 1L)),
      terminal_(isatty(STDERR_FILENO) != 0),
      quiet_(verbosity() == Verbosity::Quiet) {}

Progress::~Progress() {
  if (terminal_ && !quiet_ && shownPercent_ >= 0) std::fputs("\n", stderr);
}

void Progress::advance(long steps) {
  const long done = done_ += steps;
  if (quiet_) return;
  const long percent = std::min(100L, done * 100 / total_);
  const std::lock_guard lock(mutex_);
  const long stride = terminal_ ? 1 : 10;
  if (percent / stride <= shownPercent_ / stride) return;
  show(percent);
  shownPercent_ = percent;
}

void Progress::show(long percent) {
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const std::string bar(static_cast<size_t>(percent / 4), '=');
  const std::string line = terminal_
                               ? fmt::format("\r{} [{:<25}] {:3}% {:.1f} s", what_, bar, percent, seconds)
                               : fmt::format("{}: {}% {:.1f} s\n", what_, percent, seconds);
  std::fputs(line.c_str(), stderr);  // unlike fmt::print, it does not throw when stderr is closed
  std::fflush(stderr);
}

}  // namespace sfumato::base
