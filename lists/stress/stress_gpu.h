// Builds the lists of a load on the GPU, measures that, and judges every node of them.
#pragma once

#include "gl/device.h"
#include "lists/lists_gpu.h"
#include "lists/strategy.h"
#include "lists/stress/load.h"
#include "lists/stress/lookups_gpu.h"
#include "lists/stress/verification.h"

namespace sfumato::lists::stress {

struct Measured {
  ListStatistics statistics;
  Findings findings;
  size_t lookups = 0;
  // Wall clock, with the GPU waited for.
  double buildSeconds = 0;    // the load's draws, as often as they were issued
  double resolveSeconds = 0;  // the rest of building: scan, gather, sort, allocation
  double lookupSeconds = 0;
};

// Enables the device's profiler, and resets it. Every cell is read back and checked node by node, its lookups
// against those nodes; the buffers allocated before and after the container's must be as they were
// (Findings::overwritten). Throws Memory as Lists does.
Measured measure(gl::Device& device, const Load& load, const ListOptions& options);

}  // namespace sfumato::lists::stress
