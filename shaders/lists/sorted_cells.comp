// Lists the cells of some lengths, each length from a cursor on: a cell an invocation.
#include "shaders/lists/counting.glsl"
#include "shaders/shared/linear_id.glsl"

layout(std430, binding = STORAGE_LIST_SUMS) writeonly buffer ListSortedCells {
  uint listSortedCells[];
};

void main() {
  uint cell = linearId();
  if (cell >= uint(listWindow.range.y)) return;
  uint count = listRuns[cell].count;
  if (count < 2u) return;
  int length = findMSB(count - 1u) + 2;
  if (listTallies[LIST_TALLY_CURSORS + length] == LIST_NOT_LISTED) return;
  listSortedCells[atomicAdd(listTallies[LIST_TALLY_CURSORS + length], 1u)] = cell;
}
