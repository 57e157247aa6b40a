// Counts the samples of a pixel in which their own fragment arrived: the first in the first, and so on.
#include "shaders/shared/bindings.h"
#include "shaders/shared/resolve.h"

layout(local_size_x = 1) in;
layout(binding = TEXTURE_ROUTED_KEYS) uniform usampler2DMS arrived;
layout(std430, binding = STORAGE_COUNTERS) buffer Counting {
  ResolveCounters counters;
};

void main() {
  uint count = 0u;
  for (int i = 0; i < ROUTED_SAMPLES; ++i) {
    if (texelFetch(arrived, ivec2(0), i).r == uint(i + 1)) ++count;
  }
  counters.groups = count;
}
