// The nodes of runs while they are built: keys, and PAYLOAD_WORDS words of payload each.
#include "shaders/lists/banks.glsl"
#include "shaders/shared/bindings.h"
#include "shaders/shared/lists.h"

layout(std430, binding = STORAGE_LIST_NODES) buffer ListKeys {
  uvec2 keys[];  // ListKey
} listKeys[LIST_BANKS];
#define LIST_GET_KEY(bank, i) key = listKeys[bank].keys[i]
#define LIST_SET_KEY(bank, i) listKeys[bank].keys[i] = key

uvec2 listKeyAt(uint node) {
  uvec2 key;
  LIST_IN_BANK(LIST_GET_KEY, node);
  return key;
}

void setListKey(uint node, uvec2 key) {
  LIST_IN_BANK(LIST_SET_KEY, node);
}

#if PAYLOAD_WORDS > 0
layout(std430, binding = STORAGE_LIST_PAYLOADS) buffer ListPayloads {
  uint words[];
} listPayloads[LIST_BANKS];
#define LIST_GET_WORD(bank, i) value = listPayloads[bank].words[(i) * uint(PAYLOAD_WORDS) + word]
#define LIST_SET_WORD(bank, i) listPayloads[bank].words[(i) * uint(PAYLOAD_WORDS) + word] = value

uint listWord(uint node, uint word) {
  uint value;
  LIST_IN_BANK(LIST_GET_WORD, node);
  return value;
}

void setListWord(uint node, uint word, uint value) {
  LIST_IN_BANK(LIST_SET_WORD, node);
}
#else
void setListWord(uint node, uint word, uint value) {}
#endif
