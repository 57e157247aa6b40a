// Which runs a sort works on: those of one length, up to a power of 2.
layout(std430, binding = STORAGE_LIST_SUMS) readonly buffer ListSortedCells {
  uint listSortedCells[];
};
layout(std140, binding = UNIFORM_LIST_STEP) uniform Sorting {
  ListStep sorting;  // step.x: the first cell of this length in listSortedCells, -1: all cells are gone through;
                     // step.y: how many; step.z: nodes of a block that this step brings into order; step.w: distance of
                     // the nodes compared in it, 0: mirrored; more.x: the power of 2; more.y: shorter runs are left out
};

ListRun sortedRun(uint number) {
  if (number >= uint(sorting.step.y)) return ListRun(0u, 0u);
  bool listed = sorting.step.x >= 0;
  ListRun run = listRuns[listed ? listSortedCells[uint(sorting.step.x) + number] : number];
  bool taken = run.count <= uint(sorting.more.x) && run.count > uint(sorting.more.y);
  return ListRun(run.first, taken ? run.count : 0u);
}
