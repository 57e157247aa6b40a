#include "lists/linked_lists_gpu.h"

#include <algorithm>

#include "base/error.h"
#include "gl/commands.h"
#include "shaders/shared/bindings.h"

namespace sfumato::lists {

using shared::ListCounters;
using shared::ListLink;

LinkedLists::LinkedLists(gl::Device& device, std::string label, size_t cells, size_t payloadBytes,
                         size_t expectedNodes)
    : label_(std::move(label)),
      cells_(cells),
      payloadBytes_(payloadBytes),
      heads_(device, label_ + " heads", cells * 2 * sizeof(uint32_t)),
      counters_(device, label_ + " counters", sizeof(ListCounters)) {
  allocateNodes(device, expectedNodes);
}

void LinkedLists::allocateNodes(gl::Device& device, size_t nodes) {
  capacity_ = nodes;
  links_ = gl::Buffer();  // the old pool goes before the new one comes
  payloads_ = gl::Buffer();
  links_ = gl::Buffer(device, label_ + " links", (nodes + 1) * sizeof(ListLink));
  payloads_ = gl::Buffer(device, label_ + " payloads", (nodes + 1) * payloadBytes_);
}

ListStatistics LinkedLists::build(gl::Device& device, const std::function<void()>& draw) {
  if (const auto statistics = tryBuild(device, cells_, draw)) return *statistics;
  base::fail(base::ExitCode::Memory,
             "{}: {} nodes take {:.1f} MiB, more than this device allows in one buffer: lower the resolution",
             label_, unmetDemand_, static_cast<double>(unmetDemand_ * nodeBytes()) / 0x1p20);
}

std::optional<ListStatistics> LinkedLists::tryBuild(gl::Device& device, size_t cells,
                                                    const std::function<void()>& draw) {
  const size_t most =
      static_cast<size_t>(device.limits().storageBlockBytes) / std::max(sizeof(ListLink), payloadBytes_) - 1;
  ListStatistics statistics{.cells = cells, .windows = 1};
  ListCounters counters{};
  do {
    if (counters.demand > most) {
      unmetDemand_ = counters.demand;
      return std::nullopt;
    }
    // A little more than now, so that the next window or frame fits as well.
    if (counters.demand > capacity_)
      allocateNodes(device, std::min<size_t>(counters.demand + counters.demand / 16, most));
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
  statistics.demand = counters.demand;
  statistics.capacity = capacity_;
  statistics.overflowed = counters.overflowed;
  statistics.maxSpins = counters.maxSpins;
  statistics.bytes = heads_.bytes() + links_.bytes() + payloads_.bytes();
  return statistics;
}

void LinkedLists::bind(unsigned heads, unsigned links, unsigned payloads) const {
  heads_.bindStorage(heads);
  links_.bindStorage(links);
  payloads_.bindStorage(payloads);
}

void LinkedLists::bindForBuilding() const {
  bind(STORAGE_OLD_HEADS, STORAGE_OLD_LINKS, STORAGE_OLD_PAYLOADS);
  counters_.bindStorage(STORAGE_LIST_COUNTERS);
}

std::vector<uint32_t> LinkedLists::readHeads() const {
  return heads_.readValues<uint32_t>(cells_);
}

std::vector<ListLink> LinkedLists::readLinks() const {
  return links_.readValues<ListLink>(std::min(capacity_ + 1, links_.bytes() / sizeof(ListLink)));
}

}  // namespace sfumato::lists
