// Judges lists that were read back, node by node, against the load that they were built from.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "lists/stress/load.h"

namespace sfumato::lists::stress {

// What a node sorts by.
struct NodeKey {
  float depth = 0;
  uint32_t id = 0;
};

struct Findings {
  size_t lost = 0;         // nodes of the load that are in no list
  size_t twice = 0;        // nodes that stand in a list again
  size_t foreign = 0;      // what is no node of the load, or not of that cell, or has another depth
  size_t unsorted = 0;     // nodes that do not sort after the one before them
  size_t torn = 0;         // nodes with another payload
  size_t broken = 0;       // lists that lead out of the pool
  size_t misread = 0;      // lists in which a shader's lookups found other nodes than stand there
  size_t different = 0;    // pixels of a scene that are others than with the first strategy
  size_t rebuilt = 0;      // times that the strategy lost nodes, and another one built the lists instead
  size_t overwritten = 0;  // words of memory beside the lists that changed
  size_t hidden = 0;       // nodes of a scene that lie behind opaque surfaces
  std::string fault;       // of the first cell that has one, in words; or empty

  // Everything with which something is wrong, but for the nodes that are lost.
  size_t faults() const {
    return twice + foreign + unsorted + torn + broken + misread + different + rebuilt + overwritten + hidden;
  }
  bool good() const { return lost == 0 && faults() == 0; }
  // Those of another build of the same load as well.
  Findings& operator+=(const Findings& other);
};

class Verification {
 public:
  explicit Verification(const Load& load);
  // The nodes of one cell, as read back, in order, and load.payloadWords words for each. May be called from
  // any thread; every cell once.
  void addCell(uint32_t cell, std::span<const NodeKey> nodes, std::span<const uint32_t> payloads);
  // The same for a cell whose run is not within the pool: its nodes count as lost.
  void addBrokenRun(uint32_t cell, uint32_t first, uint32_t count);
  // The same for a cell in which lookups went wrong, beside addCell().
  void addMisread(uint32_t cell);
  // When all cells were added.
  Findings findings() const;

 private:
  bool isFirst(uint32_t number);
  void add(uint32_t cell, const Findings& found);

  const Load load_;
  std::vector<std::atomic<uint64_t>> seen_;  // a bit for each node
  mutable std::mutex mutex_;
  Findings findings_;
  uint32_t faultyCell_ = UINT32_MAX;  // of findings_.fault
};

}  // namespace sfumato::lists::stress
