// listStore(cell, depth, id, payload) puts a node into the list of a cell, in the way that C++ chose (LIST_PASS).
// Define LIST_PAYLOAD before including this: the type of what a node carries, a scalar or a struct of them; without it
// listStore has no such argument. Define LIST_ENDING_ID, and spin locks keep no nodes behind one that has it.
// listWants(cell) says whether nodes of a cell are built at this time; those of other cells cost nothing.
// Linked strategies bound every loop, and what a bound stops goes to the cell's overflow list, which the gather
// takes with the others: nothing is lost.
#include "shaders/lists/banks.glsl"
#include "shaders/lists/counting.glsl"
#include "shaders/lists/order.glsl"
#include "shaders/shared/lists.h"
#if LIST_PASS <= LIST_PASS_APPEND
#include "shaders/lists/links.glsl"
#endif

#ifdef LIST_PAYLOAD
#define LIST_PAYLOAD_ARGUMENT , LIST_PAYLOAD payload
#if LIST_PASS != LIST_PASS_COUNT
layout(std430, binding = STORAGE_LIST_PAYLOADS) writeonly buffer ListPayloads {
  LIST_PAYLOAD payloads[];
} listPayloads[LIST_BANKS];
#define LIST_SET_PAYLOAD(bank, i) listPayloads[bank].payloads[i] = payload
#define LIST_STORE_PAYLOAD(i) LIST_IN_BANK(LIST_SET_PAYLOAD, i)
#endif
#else
#define LIST_PAYLOAD_ARGUMENT
#define LIST_STORE_PAYLOAD(i)
#endif

bool listWants(uint cell) {
  return cell - uint(listWindow.range.x) < uint(listWindow.range.y);
}

#if LIST_PASS == LIST_PASS_COUNT

void listStore(uint cell, float depth, uint id LIST_PAYLOAD_ARGUMENT) {
  if (listWants(cell)) atomicAdd(listRuns[cell - uint(listWindow.range.x)].count, 1u);
}

#elif LIST_PASS == LIST_PASS_LOG

layout(std430, binding = STORAGE_LIST_NODES) writeonly buffer ListLog {
  ListLogEntry listLog[];
};

// What an audit holds finished lists against: the window's nodes as they come, in no list.
void listStore(uint cell, float depth, uint id LIST_PAYLOAD_ARGUMENT) {
  uint place = cell - uint(listWindow.range.x);
  if (place < uint(listWindow.range.y)) {
    uint entry = atomicAdd(listCounters.demand, 1u);
    if (entry < uint(listWindow.range.z)) {
      listLog[entry] = ListLogEntry(place, depth, id);
      LIST_STORE_PAYLOAD(entry);
    }
  }
}

#elif LIST_PASS == LIST_PASS_SCATTER

layout(std430, binding = STORAGE_LIST_NODES) writeonly buffer ListKeys {
  uvec2 keys[];
} listKeys[LIST_BANKS];
#define LIST_STORE_KEY(bank, i) listKeys[bank].keys[i] = key

// Runs begin as empty ones that stand at their end, and grow to the front.
void listStore(uint cell, float depth, uint id LIST_PAYLOAD_ARGUMENT) {
  if (listWants(cell)) {
    uvec2 key = listKey(depth, id);
    uint node = atomicAdd(listRuns[cell - uint(listWindow.range.x)].first, 0xffffffffu) - 1u;
    LIST_IN_BANK(LIST_STORE_KEY, node);
    LIST_STORE_PAYLOAD(node);
  }
}

#else

// A new node, or 0 when the pool is full: the demand is counted all the same.
uint listAllocate() {
  uint node = atomicAdd(listCounters.demand, 1u) + 1u;
  return node < uint(listWindow.range.z) ? node : 0u;
}

#if LIST_PASS == LIST_PASS_APPEND

bool listLink(uint cell, uint node, uvec2 key, out uint tries) {
  tries = 1u;
  setLinkNext(node, atomicExchange(listHeads[cell], node));
  return true;
}

#elif LIST_PASS == LIST_PASS_SPINLOCK

// The head is the lock. The critical section stands inside the loop, so that two lanes of one SIMD vector that want the
// same lock cannot wait for each other.
bool listLink(uint cell, uint node, uvec2 key, out uint tries) {
  bool placed = false;
  bool abandoned = false;
  tries = 0u;
  while (!placed && !abandoned && tries < LIST_SPIN_LIMIT) {
    uint head = atomicExchange(listHeads[cell], LIST_LOCKED);
    if (head != LIST_LOCKED) {
      uint previous = 0u;
      uint current = head;
      uint walked = 0u;
      bool ended = false;
      while (current != 0u && !ended && walked < LIST_WALK_LIMIT && listBefore(linkKey(current), key)) {
        previous = current;
#ifdef LIST_ENDING_ID
        ended = linkKey(current).y == LIST_ENDING_ID;
#endif
        current = linkNext(current);
        ++walked;
      }
#ifdef LIST_ENDING_ID
      if (key.y == LIST_ENDING_ID) current = 0u;
#endif
      uint unlocked = head;
      if (ended) {
        placed = true;
      } else if (walked < LIST_WALK_LIMIT) {
        setLinkNext(node, current);
        if (previous != 0u) setLinkNext(previous, node);
        else unlocked = node;
        placed = true;
      } else {
        abandoned = true;
      }
      memoryBarrier();  // not memoryBarrierBuffer(): docs/drivers.md
      atomicExchange(listHeads[cell], unlocked);
    }
    ++tries;
  }
  return placed;
}

#else

// Whoever finds that another node came in between goes on from the node before: nodes are only ever added.
bool listLink(uint cell, uint node, uvec2 key, out uint tries) {
  bool placed = false;
  uint previous = 0u;
  uint walked = 0u;
  tries = 0u;
  while (!placed && tries < LIST_SPIN_LIMIT && walked < LIST_WALK_LIMIT) {
    uint current = previous != 0u ? linkNext(previous) : listHeads[cell];
    while (current != 0u && walked < LIST_WALK_LIMIT && listBefore(linkKey(current), key)) {
      previous = current;
      current = linkNext(current);
      ++walked;
    }
    if (walked < LIST_WALK_LIMIT) {
      setLinkNext(node, current);
      memoryBarrier();
      uint found = previous != 0u ? swapLinkNext(previous, current, node) : atomicCompSwap(listHeads[cell], current, node);
      placed = found == current;
    }
    ++tries;
  }
  return placed;
}

#endif

void listStore(uint cell, float depth, uint id LIST_PAYLOAD_ARGUMENT) {
  uint node = listWants(cell) ? listAllocate() : 0u;
  if (node != 0u) {
    cell -= uint(listWindow.range.x);
    uvec2 key = listKey(depth, id);
    LIST_STORE_PAYLOAD(node);
    setLinkKey(node, key);
    uint tries;
    bool placed = listLink(cell, node, key, tries);
    if (tries > 1u) {
      atomicMax(listCounters.maxSpins, tries);
      atomicAdd(listCounters.retries, tries - 1u);
      atomicAdd(listTallies[LIST_TALLY_SPINS + min(findMSB(tries - 1u), LIST_SPIN_CLASSES - 1)], 1u);
    }
    if (!placed) {
      setLinkNext(node, atomicExchange(listHeads[uint(listWindow.range.y) + cell], node));
      atomicAdd(listCounters.overflowed, 1u);
    }
  }
}

#endif
