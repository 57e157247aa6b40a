// Linked lists while they are built: heads of all cells, then the heads of their overflow lists; and the links.
#include "shaders/lists/banks.glsl"
#include "shaders/lists/counting.glsl"

layout(std430, binding = STORAGE_LIST_HEADS) coherent buffer ListHeads {
  uint listHeads[];
};
layout(std430, binding = STORAGE_LIST_NODES) coherent buffer ListLinks {
  ListLink links[];
} listLinks[LIST_BANKS];

#define LIST_GET_KEY(bank, i) key = uvec2(floatBitsToUint(listLinks[bank].links[i].depth), listLinks[bank].links[i].id)
#define LIST_SET_KEY(bank, i) listLinks[bank].links[i].depth = uintBitsToFloat(key.x); listLinks[bank].links[i].id = key.y
#define LIST_GET_NEXT(bank, i) next = listLinks[bank].links[i].next
#define LIST_SET_NEXT(bank, i) listLinks[bank].links[i].next = next
#define LIST_SWAP_NEXT(bank, i) found = atomicCompSwap(listLinks[bank].links[i].next, expected, next)

uvec2 linkKey(uint node) {
  uvec2 key;
  LIST_IN_BANK(LIST_GET_KEY, node);
  return key;
}

void setLinkKey(uint node, uvec2 key) {
  LIST_IN_BANK(LIST_SET_KEY, node);
}

uint linkNext(uint node) {
  uint next;
  LIST_IN_BANK(LIST_GET_NEXT, node);
  return next;
}

void setLinkNext(uint node, uint next) {
  LIST_IN_BANK(LIST_SET_NEXT, node);
}

// Puts `next` behind `node` if `expected` stands there. Returns what stood there.
uint swapLinkNext(uint node, uint expected, uint next) {
  uint found;
  LIST_IN_BANK(LIST_SWAP_NEXT, node);
  return found;
}
