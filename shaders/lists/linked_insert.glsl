// Sorted insertion into a cell's list under the cell's spin lock (Lindbeck 2015, section 2.2.2). The head is the
// lock. The critical section stands inside the loop, so that two lanes of one SIMD vector that want the same lock
// cannot wait for each other; every loop is bounded, and what a bound stops goes to the cell's overflow list, which
// merge_overflow.comp puts in place: nothing is lost.
#include "shaders/shared/bindings.h"
#include "shaders/shared/lists.h"

// Heads of all cells, then the heads of their overflow lists.
layout(std430, binding = STORAGE_OLD_HEADS) coherent buffer ListHeads {
  uint listHeads[];
};
layout(std430, binding = STORAGE_OLD_LINKS) coherent buffer ListLinks {
  ListLink listLinks[];
};
layout(std430, binding = STORAGE_LIST_COUNTERS) coherent buffer ListCounting {
  ListCounters listCounters;
};

// A new node, or 0 when the pool is full: the demand is counted all the same.
uint listAllocate() {
  uint node = atomicAdd(listCounters.demand, 1u) + 1u;
  return node < uint(listLinks.length()) ? node : 0u;
}

bool listBefore(uint node, float depth, uint id) {
  float nodeDepth = listLinks[node].depth;
  return nodeDepth < depth || (nodeDepth == depth && listLinks[node].id < id);
}

// Puts `node` (not 0) into the list of `cell`. The search starts at `hint`, a node that stands before it in that
// list, or 0.
void listInsert(uint cell, uint node, float depth, uint id, uint hint) {
  listLinks[node].depth = depth;
  listLinks[node].id = id;
  bool placed = false;
  bool abandoned = false;
  uint spins = 0u;
  while (!placed && !abandoned && spins < LIST_SPIN_LIMIT) {
    uint head = atomicExchange(listHeads[cell], LIST_LOCKED);
    if (head != LIST_LOCKED) {
      uint previous = hint;
      uint current = hint != 0u ? listLinks[hint].next : head;
      uint walked = 0u;
      while (current != 0u && walked < LIST_WALK_LIMIT && listBefore(current, depth, id)) {
        previous = current;
        current = listLinks[current].next;
        ++walked;
      }
      uint unlocked = head;
      if (walked < LIST_WALK_LIMIT) {
        listLinks[node].next = current;
        if (previous != 0u) listLinks[previous].next = node;
        else unlocked = node;
        placed = true;
      } else {
        abandoned = true;
      }
      memoryBarrierBuffer();
      atomicExchange(listHeads[cell], unlocked);
    }
    ++spins;
  }
  if (spins > 1u) atomicMax(listCounters.maxSpins, spins);
  if (!placed) {
    uint overflow = uint(listHeads.length()) / 2u + cell;
    listLinks[node].next = atomicExchange(listHeads[overflow], node);
    atomicAdd(listCounters.overflowed, 1u);
    atomicAdd(listCounters.unmerged, 1u);
  }
}
