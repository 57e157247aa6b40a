// Runs that are too long for one sort in registers: their cells by length, each length up to a power of 2.
layout(std430, binding = STORAGE_LIST_SUMS) buffer ListLongCells {
  uint listLongCells[];
};
layout(std140, binding = UNIFORM_LIST_STEP) uniform Sorting {
  ListStep sorting;  // step.x: the first cell of this length in listLongCells; y: how many; z: nodes of a block that this
                     // step brings into order; w: distance of the nodes compared in it, 0: mirrored;
                     // more.x: that power of 2
};

ListRun longRun(uint number) {
  if (number >= uint(sorting.step.y)) return ListRun(0u, 0u);
  return listRuns[listLongCells[uint(sorting.step.x) + number]];
}
