// The rays through a window's pixels: one each, or one for each sample of those that are split.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sfumato::pipelines {

// Their numbers: see shaders/shared/resolve.h.
struct SplitRays {
  size_t pixels = 0;
  std::vector<uint32_t> groups;  // pixelGroups of them; empty: none is split
  size_t further = 0;            // rays of a split pixel beside its first one

  // Calls visit(number) for the rays of a pixel.
  template <typename Visit>
  void forEachRay(size_t pixel, const Visit& visit) const {
    visit(pixel);
    const uint32_t group = groups.empty() ? 0 : groups[pixel];
    if (group != 0)
      for (size_t i = 0; i < further; ++i) visit(pixels + (group - 1) * further + i);
  }
};

}  // namespace sfumato::pipelines
