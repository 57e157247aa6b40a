// Stores the nodes of a load, one an invocation: contention across lanes, workgroups and threads. STRESS_NODES says
// which of them: STRESS_* of shaders/shared/stress.h.
#include "shaders/lists/stress/load.glsl"
#include "shaders/shared/linear_id.glsl"
#if LOAD_WORDS > 0
struct StressPayload {
  uint words[LOAD_WORDS];
};
#define LIST_PAYLOAD StressPayload
#endif
#include "shaders/lists/insert.glsl"

#if STRESS_NODES == STRESS_NUMBERS
layout(std430, binding = STORAGE_STRESS_NUMBERS) readonly buffer Numbers {
  uint numbers[];
};
#endif

uint nodeNumber(uint index) {
#if STRESS_NODES == STRESS_NUMBERS
  return numbers[uint(stressParams.window.w) + index];
#elif STRESS_NODES == STRESS_LAYERS
  uint cells = uint(stressParams.window.y);
  uint layer = index / cells;
  return layer * uint(stressParams.load.x * stressParams.load.y) + uint(stressParams.window.x) + (index - layer * cells);
#else
  return index;
#endif
}

void main() {
  uint index = linearId();
  if (index >= uint(stressParams.window.z)) return;
  uint number = nodeNumber(index);
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
