// Progress of long work, on stderr: a bar on a terminal, a line every 10 % elsewhere, nothing when quiet.
#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <string>

namespace sfumato::base {

class Progress {
 public:
  // `what` is shown before the bar; `total` is the number of advance() steps, at least 1.
  Progress(std::string what, long total);
  ~Progress();  // ends the bar's line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void advance(long steps = 1);  // may be called from any thread

 private:
  void show(long percent);

  const std::string what_;
  const long total_;
  const bool terminal_;
  const bool quiet_;
  std::atomic<long> done_ = 0;
  std::mutex mutex_;
  long shownPercent_ = -1;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace sfumato::base
