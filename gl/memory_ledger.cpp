#include "gl/memory_ledger.h"

#include <algorithm>

namespace sfumato::gl {

void MemoryLedger::add(const std::string& label, size_t bytes) {
  size_t& labelled = bytesByLabel_[label];
  labelled += bytes;
  size_t& peak = peakBytesByLabel_[label];
  peak = std::max(peak, labelled);
  bytes_ += bytes;
  peakBytes_ = std::max(peakBytes_, bytes_);
}

void MemoryLedger::remove(const std::string& label, size_t bytes) {
  const auto entry = bytesByLabel_.find(label);
  if (entry == bytesByLabel_.end()) return;
  entry->second -= bytes;
  if (entry->second == 0) bytesByLabel_.erase(entry);
  bytes_ -= bytes;
}

void MemoryLedger::restartPeaks() {
  peakBytesByLabel_ = bytesByLabel_;
  peakBytes_ = bytes_;
}

}  // namespace sfumato::gl
