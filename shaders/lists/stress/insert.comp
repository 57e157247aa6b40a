// Stores the nodes of a load, one an invocation: contention across lanes, workgroups and threads.
#include "shaders/lists/stress/load.glsl"
#include "shaders/shared/linear_id.glsl"
#if LOAD_WORDS > 0
struct StressPayload {
  uint words[LOAD_WORDS];
};
#define LIST_PAYLOAD StressPayload
#endif
#include "shaders/lists/insert.glsl"

void main() {
  uint index = linearId();
  if (index >= uint(stressParams.window.z)) return;
  uint number = index;
  if (stressParams.window.w != 0) {
    // Layer after layer of the window's cells.
    uint cells = uint(stressParams.window.y);
    uint layer = index / cells;
    number = layer * uint(stressParams.load.x * stressParams.load.y) + uint(stressParams.window.x) + (index - layer * cells);
  }
  uint cell;
  float depth;
  loadNode(number, cell, depth);
#if LOAD_WORDS > 0
  StressPayload payload;
  for (uint word = 0u; word < LOAD_WORDS; ++word) payload.words[word] = loadPayload(number, word);
  listStore(cell, depth, number, payload);
#else
  listStore(cell, depth, number);
#endif
}
