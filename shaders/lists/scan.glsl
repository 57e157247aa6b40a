// A scan over the counts of cells, by sums of blocks, of blocks of blocks, and so on.
layout(std430, binding = STORAGE_LIST_SUMS) buffer ListSums {
  uint listSums[];
};
layout(std140, binding = UNIFORM_LIST_STEP) uniform Scan {
  ListStep scan;  // x: how many are added up; y: where they stand in listSums; z: where their sums do, -1: there is only
                  // one; w: 1 where a cell's offset is that behind its nodes
};

uint saturatingSum(uint a, uint b) {
  uint sum = a + b;
  return sum < a ? 0xffffffffu : sum;
}
