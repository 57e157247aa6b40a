// After the scatter every run begins where the one before it ends: a cell an invocation.
#include "shaders/lists/counting.glsl"
#include "shaders/shared/linear_id.glsl"

void main() {
  uint cell = linearId();
  if (cell >= uint(listWindow.range.y)) return;
  uint begin = cell == 0u ? 0u : listRuns[cell - 1u].first + listRuns[cell - 1u].count;
  if (listRuns[cell].first != begin) atomicAdd(listCounters.broken, 1u);
}
