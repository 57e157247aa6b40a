// The list container: cells, each with a linked list of nodes sorted by (depth, id).
#include "shaders/shared/glsl.h"
SHARED_BEGIN

// What every node has; its payload, if any, stands at the same index in a buffer of its own. Node 0 is the end of
// every list and holds nothing, because lanes that are masked off read zeros.
struct ListLink {
  float depth;  // sorts first
  uint id;      // sorts second: what was drawn, unique within a cell for equal depths
  uint next;    // node, 0: the end
};

struct ListCounters {
  uint demand;      // nodes asked for, counted past the capacity
  uint overflowed;  // nodes that a bounded spin or walk sent to the cell's overflow list
  uint unmerged;    // overflowed nodes that no merge has put in their place yet
  uint maxSpins;    // most tries that a lock took
};

SHARED_END

// A head that stands for "somebody is changing this list".
#define LIST_LOCKED 0xffffffffu
// Tries for a lock, and nodes walked under it, before a node goes to the overflow list. Together they keep an
// insertion far below the 65,535 loop iterations at which some drivers end every loop silently.
#ifndef LIST_SPIN_LIMIT
#define LIST_SPIN_LIMIT 2048
#endif
#ifndef LIST_WALK_LIMIT
#define LIST_WALK_LIMIT 16384
#endif
