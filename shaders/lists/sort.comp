// Sorts LIST_SORT_SIZE nodes or fewer in registers, an invocation each: a run, or a piece of a longer one.
// LIST_NETWORK is a sequence of S(i, j), which puts elements i < j in order; LIST_EACH is E(i) for every element
// (lists/sorting_network.h).
#include "shaders/lists/counting.glsl"
#include "shaders/lists/order.glsl"
#include "shaders/lists/pool.glsl"
#include "shaders/shared/linear_id.glsl"
#include "shaders/lists/sorted_runs.glsl"

int rank[LIST_SORT_SIZE];
uint id[LIST_SORT_SIZE];
uint from[LIST_SORT_SIZE];

void order(inout int rankA, inout uint idA, inout uint fromA, inout int rankB, inout uint idB, inout uint fromB) {
  bool swapped = rankB < rankA || (rankB == rankA && idB < idA);
  int lowRank = swapped ? rankB : rankA;
  uint lowId = swapped ? idB : idA;
  uint lowFrom = swapped ? fromB : fromA;
  rankB = swapped ? rankA : rankB;
  idB = swapped ? idA : idB;
  fromB = swapped ? fromA : fromB;
  rankA = lowRank;
  idA = lowId;
  fromA = lowFrom;
}

#define S(i, j) order(rank[i], id[i], from[i], rank[j], id[j], from[j]);

void main() {
  uint pieces = max(uint(sorting.more.x) / uint(LIST_SORT_SIZE), 1u);
  ivec2 pieceRun = placeInRows(linearId(), int(pieces));
  ListRun run = sortedRun(uint(pieceRun.y));
  uint offset = uint(pieceRun.x) * uint(LIST_SORT_SIZE);
  if (offset >= run.count) return;
  uint first = run.first + offset;
  uint count = min(run.count - offset, uint(LIST_SORT_SIZE));

  // What is not there sorts behind everything.
#define E(i)                                \
  rank[i] = 0x7fffffff;                     \
  id[i] = 0xffffffffu;                      \
  from[i] = uint(i);                        \
  if (uint(i) < count) {                    \
    uvec2 key = listKeyAt(first + uint(i)); \
    rank[i] = listRank(key.x);              \
    id[i] = key.y;                          \
  }
  LIST_EACH
#undef E
  LIST_NETWORK
#define E(i) \
  if (uint(i) < count) setListKey(first + uint(i), uvec2(uint(listRank(uint(rank[i]))), id[i]));
  LIST_EACH
#undef E
#if PAYLOAD_WORDS > 0
  uint words[LIST_SORT_SIZE];
  // Not told as a constant, so that the loop is not unrolled: drivers compile that for a quarter of a second.
  uint payloadWords = count == 0u ? 0u : uint(PAYLOAD_WORDS);
  for (uint word = 0u; word < payloadWords; ++word) {
#define E(i) \
    if (uint(i) < count) words[i] = listWord(first + from[i], word);
    LIST_EACH
#undef E
#define E(i) \
    if (uint(i) < count) setListWord(first + uint(i), word, words[i]);
    LIST_EACH
#undef E
  }
#endif
}
