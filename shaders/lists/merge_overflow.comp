// Puts the nodes of each cell's overflow list in their sorted place. One invocation owns a cell, so no lock is
// needed; one that has walked far stops, and the pass is run again until listCounters.unmerged is 0.
#include "shaders/lists/linked_insert.glsl"
#include "shaders/shared/linear_id.glsl"

const uint WORK_LIMIT = 30000u;

void main() {
  uint cells = uint(listHeads.length()) / 2u;
  uint cell = linearId();
  if (cell >= cells) return;
  uint node = listHeads[cells + cell];
  uint previous = 0u;  // the place found so far for `node`
  uint current = listHeads[cell];
  uint merged = 0u;
  // A walk longer than the limit still ends with its node: it is placed and the next one is left for later.
  for (uint work = 0u; node != 0u && (work < WORK_LIMIT || merged == 0u); ++work) {
    if (current != 0u && listBefore(current, listLinks[node].depth, listLinks[node].id)) {
      previous = current;
      current = listLinks[current].next;
    } else {
      uint following = listLinks[node].next;
      listLinks[node].next = current;
      if (previous != 0u) {
        listLinks[previous].next = node;
      } else {
        listHeads[cell] = node;
      }
      ++merged;
      node = following;
      previous = 0u;
      current = listHeads[cell];
    }
  }
  if (merged != 0u) {
    listHeads[cells + cell] = node;
    atomicAdd(listCounters.unmerged, uint(-int(merged)));
  }
}
