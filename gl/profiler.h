// How long each pass takes, by the GPU's clock and by the wall's.
#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace sfumato::gl {

struct PassTime {
  std::string name;
  double gpuMilliseconds = 0;   // between two timestamps in the command stream
  double wallMilliseconds = 0;  // with the passes' work waited for, so that it belongs to the pass
  int calls = 0;                // passes of one name are added up
};

// Off until enabled: then every pass waits for the GPU at its end, which costs a little and separates the
// passes.
class Profiler {
 public:
  // From construction to destruction: one pass. May be nested; names then read "outer/inner".
  class Scope {
   public:
    Scope(Profiler& profiler, const std::string& name);
    ~Scope();
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    Profiler& profiler_;
    unsigned startQuery_ = 0;
    std::chrono::steady_clock::time_point start_;
    size_t prefixLength_ = 0;
  };

  void enable(bool enabled = true) { enabled_ = enabled; }       // between passes
  const std::vector<PassTime>& times() const { return times_; }  // in order of first end
  void reset() { times_.clear(); }

 private:
  friend class Scope;
  PassTime& entry(const std::string& name);

  bool enabled_ = false;
  std::string path_;
  std::vector<PassTime> times_;
};

}  // namespace sfumato::gl
