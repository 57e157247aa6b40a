// Lists the cells of runs that are too long for one sort in registers, by length: a cell an invocation.
#include "shaders/lists/counting.glsl"
#include "shaders/shared/linear_id.glsl"

layout(std430, binding = STORAGE_LIST_SUMS) writeonly buffer ListLongCells {
  uint listLongCells[];
};

void main() {
  uint cell = linearId();
  if (cell >= uint(listWindow.range.y)) return;
  uint count = listRuns[cell].count;
  if (count <= uint(LIST_SHORT_RUN)) return;
  int length = findMSB(count - 1u) + 2;
  listLongCells[atomicAdd(listTallies[LIST_TALLY_CURSORS + length], 1u)] = cell;
}
