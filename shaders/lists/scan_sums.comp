// The way up of the scan: each invocation adds up a block of LIST_SCAN_BLOCK counts. SCAN_CELLS: those of the cells,
// which are tallied by length; else sums of the level below. Sums stay at 0xffffffff once they reach it.
#include "shaders/lists/counting.glsl"
#include "shaders/lists/scan.glsl"
#include "shaders/shared/linear_id.glsl"

void main() {
  uint block = linearId();
  uint end = min((block + 1u) * LIST_SCAN_BLOCK, uint(scan.step.x));
  uint i = block * LIST_SCAN_BLOCK;
  if (i >= end) return;
  uint sum = 0u;
#ifdef SCAN_CELLS
  uint longest = 0u;
  // Eight tallies of a byte each; a block fills none beyond 64. Longer lists are rare.
  uint shorter = 0u;
  uint longer = 0u;
  for (; i < end; ++i) {
    uint count = listRuns[i].count;
    int length = count == 0u ? 0 : findMSB(count - 1u) + 2;
    if (length < 4) shorter += 1u << (8 * length);
    else if (length < 8) longer += 1u << (8 * length - 32);
    else atomicAdd(listTallies[LIST_TALLY_LENGTHS + length], 1u);
    longest = max(longest, count);
    sum = saturatingSum(sum, count);
  }
  for (int length = 0; length < 8; ++length) {
    uint tally = ((length < 4 ? shorter : longer) >> (8 * (length & 3))) & 0xffu;
    if (tally != 0u) atomicAdd(listTallies[LIST_TALLY_LENGTHS + length], tally);
  }
  atomicMax(listCounters.longest, longest);
  listSums[block] = sum;
#else
  for (; i < end; ++i) sum = saturatingSum(sum, listSums[uint(scan.step.y) + i]);
  listSums[uint(scan.step.z) + block] = sum;
#endif
}
