// Pushes items into lists as the list checks want it. One buffer holds all links: the heads of HEADS lists, then the
// `next` of each node, so that a place in a list is one number whatever it is. Node 0 is the end.
//
// HEAD_OF: the list of `item`; CAPACITY: nodes in the pool, the one that nobody uses counted.
// PUSH_EXCHANGE, PUSH_COMPARE, PUSH_SORTED: how; PUSH_PLAIN, the control: by plain loads and stores.
// HEADS_IN_IMAGE: heads are texels of an image of HEADS texels a row (PUSH_EXCHANGE and PUSH_PLAIN only).
#include "shaders/shared/hash.glsl"

layout(std430, binding = 0) coherent buffer Links {
  uint links[];
};
layout(std430, binding = 1) coherent buffer Items {
  uint items[];
};
layout(std430, binding = 2) coherent buffer Outcome {
  uint demand;
  uint gaveUp;  // pushes that the bound of a loop stopped: their node is in no list
  uint retries;
  uint maxTries;
};
#ifdef HEADS_IN_IMAGE
layout(r32ui, binding = 0) coherent uniform uimage2D headImage;
#endif

const uint TRY_LIMIT = 16384u;
const uint WALK_LIMIT = 1024u;

// What a sorted list is sorted by, before the item itself.
uint keyOf(uint item) {
  return hash(item) % 1000u;
}

bool standsBefore(uint node, uint item) {
  uint other = items[node];
  uint key = keyOf(item);
  uint otherKey = keyOf(other);
  return otherKey < key || (otherKey == key && other < item);
}

void pushExchange(uint list, uint node) {
#if defined(PUSH_PLAIN) || defined(MUTANT_NO_ATOMIC)
#ifdef HEADS_IN_IMAGE
  uint before = imageLoad(headImage, ivec2(int(list), 0)).x;
  imageStore(headImage, ivec2(int(list), 0), uvec4(node));
#else
  uint before = links[list];
  links[list] = node;
#endif
#elif defined(HEADS_IN_IMAGE)
  uint before = imageAtomicExchange(headImage, ivec2(int(list), 0), node);
#else
  uint before = atomicExchange(links[list], node);
#endif
  links[HEADS + node] = before;
}

// One compare-and-swap; with the mutant the value is compared and swapped without anything atomic.
uint compareAndSwap(uint place, uint expected, uint node) {
#if defined(PUSH_PLAIN) || defined(MUTANT_NO_ATOMIC)
  uint before = links[place];
  if (before == expected) links[place] = node;
  return before;
#else
  return atomicCompSwap(links[place], expected, node);
#endif
}

void countTries(bool done, uint tries) {
  if (!done) atomicAdd(gaveUp, 1u);
  if (tries > 1u) {
    atomicAdd(retries, tries - 1u);
    atomicMax(maxTries, tries);
  }
}

void pushCompare(uint list, uint node) {
  uint expected = links[list];
  bool done = false;
  uint tries = 0u;
  while (!done && tries < TRY_LIMIT) {
    links[HEADS + node] = expected;
    memoryBarrierBuffer();
    uint before = compareAndSwap(list, expected, node);
    if (before == expected) done = true;
    expected = before;
    ++tries;
  }
  countTries(done, tries);
}

// The place is searched from the head again after each failure, so that every loop is short.
void pushSorted(uint list, uint node, uint item) {
  bool done = false;
  uint tries = 0u;
  while (!done && tries < TRY_LIMIT) {
    uint place = list;
    uint current = links[place];
    uint walked = 0u;
    while (current != 0u && walked < WALK_LIMIT && standsBefore(current, item)) {
      place = HEADS + current;
      current = links[place];
      ++walked;
    }
    links[HEADS + node] = current;
    memoryBarrierBuffer();
    if (walked < WALK_LIMIT && compareAndSwap(place, current, node) == current) done = true;
    ++tries;
  }
  countTries(done, tries);
}

void push(uint item) {
  uint node = atomicAdd(demand, 1u) + 1u;
#ifndef MUTANT_NO_BOUND
  if (node >= CAPACITY) return;
#endif
  uint list = HEAD_OF;
  items[node] = item;
#if defined(PUSH_SORTED)
  pushSorted(list, node, item);
#elif defined(PUSH_COMPARE)
  pushCompare(list, node);
#else
  pushExchange(list, node);
#endif
}
