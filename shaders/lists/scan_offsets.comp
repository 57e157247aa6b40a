// The way down of the scan: each invocation turns a block of sums, or with SCAN_CELLS of counts, into offsets.
#include "shaders/lists/counting.glsl"
#include "shaders/lists/scan.glsl"
#include "shaders/shared/linear_id.glsl"

void main() {
  uint block = linearId();
  uint end = min((block + 1u) * LIST_SCAN_BLOCK, uint(scan.step.x));
  uint i = block * LIST_SCAN_BLOCK;
  if (i >= end) return;
  uint offset = scan.step.z >= 0 ? listSums[uint(scan.step.z) + block] : 0u;
  for (; i < end; ++i) {
#ifdef SCAN_CELLS
    uint next = saturatingSum(offset, listRuns[i].count);
    listRuns[i].first = scan.step.w != 0 ? next : offset;
#else
    uint next = saturatingSum(offset, listSums[uint(scan.step.y) + i]);
    listSums[uint(scan.step.y) + i] = offset;
#endif
    offset = next;
  }
  if (scan.step.z < 0) listCounters.total = offset;
}
