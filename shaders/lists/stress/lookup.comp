// Looks into a cell's run as a marching ray does: how many nodes stand at or before each of LOOKUPS depths that only
// grow. The cursor only moves forward; it strides, then halves, so that long runs cost little more than short ones.
#include "shaders/lists/runs.glsl"
#include "shaders/shared/linear_id.glsl"
#include "shaders/shared/stress.h"

layout(std140, binding = UNIFORM_PASS) uniform StressPass {
  StressParams stressParams;
};
layout(std430, binding = STORAGE_COUNTERS) writeonly buffer Sums {
  uint sums[];  // of a cell's lookups
};

void main() {
  uint cell = linearId();
  if (cell >= uint(stressParams.window.y)) return;
  ListRun run = listRun(cell);
  uint end = run.first + run.count;
  uint cursor = run.first;
  uint sum = 0u;
  for (uint lookup = 1u; lookup <= LOOKUPS; ++lookup) {
    float depth = stressParams.lookups.x * (float(lookup) / float(LOOKUPS));
    uint stride = 1u;
    while (cursor + stride <= end && listDepth(cursor + stride - 1u) <= depth) {
      cursor += stride;
      stride *= 2u;
    }
    uint high = min(cursor + stride - 1u, end);
    while (cursor < high) {
      uint middle = (cursor + high) / 2u;
      if (listDepth(middle) <= depth) cursor = middle + 1u;
      else high = middle;
    }
    sum += cursor - run.first;
  }
  sums[cell] = sum;
}
