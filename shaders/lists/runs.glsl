// The lists of a container for readers: of each cell the nodes [first, first + count), ascending by (depth, id).
#include "shaders/shared/bindings.h"
#include "shaders/shared/lists.h"

layout(binding = TEXTURE_LIST_RUNS) uniform usamplerBuffer listRuns;  // ListRun
layout(binding = TEXTURE_LIST_KEYS) uniform usamplerBuffer listKeys;  // ListKey
layout(binding = TEXTURE_LIST_PAYLOADS) uniform usamplerBuffer listPayloads;  // words, or pairs where they are even

ListRun listRun(uint cell) {
  uvec2 run = texelFetch(listRuns, int(cell)).xy;
  return ListRun(run.x, run.y);
}

ListKey listKey(uint node) {
  uvec2 key = texelFetch(listKeys, int(node)).xy;
  return ListKey(uintBitsToFloat(key.x), key.y);
}

float listDepth(uint node) {
  return uintBitsToFloat(texelFetch(listKeys, int(node)).x);
}

uint listPayloadWord(uint word) {
  return texelFetch(listPayloads, int(word)).x;
}

uvec2 listPayloadPair(uint pair) {
  return texelFetch(listPayloads, int(pair)).xy;
}
