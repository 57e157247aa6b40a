#include "lists/lists_gpu.h"

#include <algorithm>

#include "gl/commands.h"
#include "shaders/shared/bindings.h"

namespace sfumato::lists {

using shared::ListCounters;
using shared::ListLink;

Lists::Lists(gl::Device& device, std::string label, size_t cells, size_t payloadBytes, size_t expectedNodes)
    : label_(std::move(label)),
      cells_(cells),
      payloadBytes_(payloadBytes),
      heads_(device, label_ + " heads", cells * 2 * sizeof(uint32_t)),
      counters_(device, label_ + " counters", sizeof(ListCounters)) {
  allocateNodes(device, expectedNodes);
}

void Lists::allocateNodes(gl::Device& device, size_t nodes) {
  capacity_ = nodes;
  links_ = gl::Buffer();  // the old pool goes before the new one comes
  payloads_ = gl::Buffer();
  links_ = gl::Buffer(device, label_ + " links", (nodes + 1) * sizeof(ListLink));
  payloads_ = gl::Buffer(device, label_ + " payloads", (nodes + 1) * payloadBytes_);
}

ListStatistics Lists::build(gl::Device& device, const std::function<void()>& draw) {
  ListStatistics statistics;
  ListCounters counters{};
  do {
    if (counters.demand > capacity_) allocateNodes(device, counters.demand + counters.demand / 16);
    heads_.clear();
    counters_.clear();
    bindForBuilding();
    draw();
    gl::storageBarrier();
    counters = counters_.readValue<ListCounters>();
    ++statistics.builds;
  } while (counters.demand > capacity_);

  while (counters.unmerged > 0) {
    bindForBuilding();
    gl::dispatchLinear(device.program({"lists/merge_overflow.comp"}), cells_);
    gl::storageBarrier();
    counters = counters_.readValue<ListCounters>();
  }
  statistics.cells = cells_;
  statistics.demand = counters.demand;
  statistics.capacity = capacity_;
  statistics.overflowed = counters.overflowed;
  statistics.maxSpins = counters.maxSpins;
  statistics.bytes = heads_.bytes() + links_.bytes() + payloads_.bytes();
  return statistics;
}

void Lists::bind(unsigned heads, unsigned links, unsigned payloads) const {
  heads_.bindStorage(heads);
  links_.bindStorage(links);
  payloads_.bindStorage(payloads);
}

void Lists::bindForBuilding() const {
  bind(STORAGE_LIST_HEADS, STORAGE_LIST_LINKS, STORAGE_LIST_PAYLOADS);
  counters_.bindStorage(STORAGE_LIST_COUNTERS);
}

std::vector<uint32_t> Lists::readHeads() const {
  return heads_.readValues<uint32_t>(cells_);
}

std::vector<ListLink> Lists::readLinks() const {
  return links_.readValues<ListLink>(std::min(capacity_ + 1, links_.bytes() / sizeof(ListLink)));
}

}  // namespace sfumato::lists
