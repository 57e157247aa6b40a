// One step of a bitonic sort of long runs (Batcher 1968), in place, two nodes an invocation. The first step of a block
// compares mirrored nodes, so that all blocks ascend and runs of any length may end anywhere in them.
#include "shaders/lists/counting.glsl"
#include "shaders/lists/sorted_runs.glsl"
#include "shaders/lists/order.glsl"
#include "shaders/lists/pool.glsl"
#include "shaders/shared/linear_id.glsl"

void main() {
  uint pairs = uint(sorting.more.x) / 2u;
  ivec2 pairRun = placeInRows(linearId(), int(pairs));
  ListRun run = sortedRun(uint(pairRun.y));
  uint pair = uint(pairRun.x);
  bool mirrored = sorting.step.w == 0;
  uint distance = mirrored ? uint(sorting.step.z) / 2u : uint(sorting.step.w);
  ivec2 placeBlock = placeInRows(pair, int(distance));
  uint block = uint(placeBlock.y) * 2u * distance;
  uint a = block + uint(placeBlock.x);
  uint b = mirrored ? block + 2u * distance - 1u - uint(placeBlock.x) : a + distance;
  if (b >= run.count) return;
  a += run.first;
  b += run.first;
  uvec2 keyA = listKeyAt(a);
  uvec2 keyB = listKeyAt(b);
  if (!listBefore(keyB, keyA)) return;
  setListKey(a, keyB);
  setListKey(b, keyA);
#if PAYLOAD_WORDS > 0
  for (uint word = 0u; word < uint(PAYLOAD_WORDS); ++word) {
    uint wordA = listWord(a, word);
    setListWord(a, word, listWord(b, word));
    setListWord(b, word, wordA);
  }
#endif
}
