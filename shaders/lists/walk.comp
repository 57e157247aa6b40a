// Counts the nodes of each linked list, a cell an invocation, and puts its overflow list behind it. A long walk goes on
// in the next dispatch from the node in the run's `first`; one that leaves the pool or does not end is cut and counted.
#include "shaders/lists/links.glsl"
#include "shaders/shared/linear_id.glsl"

layout(std140, binding = UNIFORM_LIST_STEP) uniform Walk {
  ListStep walk;  // x: 1 for the first dispatch
};

const uint WORK_LIMIT = 30000u;

void main() {
  uint cells = uint(listWindow.range.y);
  uint nodes = uint(listWindow.range.z);
  uint cell = linearId();
  if (cell >= cells) return;
  uint node = walk.step.x != 0 ? listHeads[cell] : listRuns[cell].first;
  uint count = walk.step.x != 0 ? 0u : listRuns[cell].count;
  uint overflow = listHeads[cells + cell];
  if (node == 0u && overflow == 0u) {
    if (walk.step.x != 0) listRuns[cell] = ListRun(0u, 0u);
    return;
  }
  if (node == 0u) {
    listHeads[cell] = overflow;
    listHeads[cells + cell] = 0u;
    node = overflow;
    overflow = 0u;
  }
  uint work = 0u;
  while (node != 0u && node < nodes && count < nodes && work < WORK_LIMIT) {
    uint next = linkNext(node);
    if (next == 0u && overflow != 0u) {
      setLinkNext(node, overflow);
      listHeads[cells + cell] = 0u;
      next = overflow;
      overflow = 0u;
    }
    node = next;
    ++count;
    ++work;
  }
  if (node >= nodes || (node != 0u && count >= nodes)) {
    atomicAdd(listCounters.broken, 1u);
    node = 0u;
  }
  if (node != 0u) atomicAdd(listCounters.unfinished, 1u);
  listRuns[cell] = ListRun(node, count);
}
