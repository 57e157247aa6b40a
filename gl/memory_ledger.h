// Who holds how much GPU memory: every buffer and texture enters itself here under its label.
#pragma once

#include <cstddef>
#include <map>
#include <string>

namespace sfumato::gl {

class MemoryLedger {
 public:
  void add(const std::string& label, size_t bytes);
  void remove(const std::string& label, size_t bytes);
  // From now on, peaks are those of what comes, and of what is there now.
  void restartPeaks();

  const std::map<std::string, size_t>& peakBytesByLabel() const {
    return peakBytesByLabel_;
  }  // of each label alone
  size_t bytes() const { return bytes_; }
  size_t peakBytes() const { return peakBytes_; }

 private:
  std::map<std::string, size_t> bytesByLabel_;
  std::map<std::string, size_t> peakBytesByLabel_;
  size_t bytes_ = 0;
  size_t peakBytes_ = 0;
};

}  // namespace sfumato::gl
