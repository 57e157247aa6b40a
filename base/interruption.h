// Ctrl-C, for work that ends in good order with what it has so far.
#pragma once

#include <csignal>
#include <initializer_list>
#include <utility>
#include <vector>

namespace sfumato::base {

// While it lives, the first of `signals` (each the first time) does not end this program but is noted,
// whichever thread it comes to; the second time it ends the program. One at a time. Throws Bug when there is
// no pipe left.
class Interruption {
 public:
  explicit Interruption(std::initializer_list<int> signals);
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  bool happened() const;
  // A file descriptor that can be read from once it has happened, for poll().
  int stream() const;

 private:
  std::vector<std::pair<int, struct sigaction>> before_;
};

}  // namespace sfumato::base
