// The list container on the GPU: cells, each with a linked list of nodes sorted by (depth, id), built by
// shaders that include shaders/lists/insert.glsl (strategy `spinlock`: Lindbeck 2015, section 2.2.2). Nothing
// is lost: the demand is counted past the capacity, the pool then grows to it and the lists are built again.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "gl/buffer.h"
#include "gl/device.h"
#include "gl/program.h"
#include "lists/strategy.h"
#include "shaders/shared/lists.h"

namespace sfumato::lists {

class LinkedLists {
 public:
  // Empty lists. `payloadBytes` a node, a multiple of 4, may be 0; `expectedNodes` is the first capacity.
  // Costs 8 bytes a cell and 12 + payloadBytes a node. Throws Memory over the device's limit of one block.
  LinkedLists(gl::Device& device, std::string label, size_t cells, size_t payloadBytes, size_t expectedNodes);

  // Builds all lists: `draw` issues the draws and dispatches that insert; it is called again when the pool
  // had to grow. The lists are bound (STORAGE_LIST_*) while it runs.
  // Throws Memory, and says how much it takes, when the device cannot hold them in one buffer.
  ListStatistics build(gl::Device& device, const std::function<void()>& draw);
  // The same with only the first `cells`, but nothing where build() throws: the caller can try fewer cells at
  // a time.
  std::optional<ListStatistics> tryBuild(gl::Device& device, size_t cells, const std::function<void()>& draw);

  // Binds heads, links, payloads for readers at these storage bindings.
  void bind(unsigned heads, unsigned links, unsigned payloads) const;
  void bindForBuilding() const;

  // Read back, for checks on the CPU.
  std::vector<uint32_t> readHeads() const;
  std::vector<shared::ListLink> readLinks() const;
  const gl::Buffer& payloads() const { return payloads_; }
  gl::Buffer& countersForTest() { return counters_; }

 private:
  void allocateNodes(gl::Device& device, size_t nodes);
  size_t nodeBytes() const { return sizeof(shared::ListLink) + payloadBytes_; }

  std::string label_;
  size_t cells_;
  size_t payloadBytes_;
  size_t capacity_ = 0;
  size_t unmetDemand_ = 0;  // of the last build that failed
  gl::Buffer heads_;
  gl::Buffer links_;
  gl::Buffer payloads_;
  gl::Buffer counters_;
};

}  // namespace sfumato::lists
