// The list container: cells, each with a run of nodes sorted by (depth, id).
#pragma once
#include "shaders/shared/glsl.h"
SHARED_BEGIN

// What every node has; its payload, if any, stands at the same index in a buffer of its own.
struct ListKey {
  float depth;  // sorts first
  uint id;      // sorts second: what was drawn, unique within a cell for equal depths
};

// The nodes of one cell: [first, first + count), ascending.
struct ListRun {
  uint first;
  uint count;
};

// A node of a linked list, on the way to a run. Node 0 is the end of every list and holds nothing, because lanes
// that are masked off read zeros.
struct ListLink {
  float depth;
  uint id;
  uint next;  // node, 0: the end
};

// A node as an audit notes it down, before any list has it.
struct ListLogEntry {
  uint cell;  // from the window's first
  float depth;
  uint id;
};

struct ListCounters {
  uint demand;      // nodes asked of a linked pool, counted past its capacity
  uint overflowed;  // nodes that a bounded loop sent to the cell's overflow list
  uint maxSpins;    // most tries that one insertion took
  uint retries;     // tries beyond each insertion's first
  uint longest;     // nodes of the longest list
  uint total;       // nodes of all lists; 0xffffffff: that many or more
  uint unfinished;  // lists whose walk needs another dispatch
  uint broken;      // lists that left their pool or had no end
  uint unsorted;    // nodes that came before their predecessor in a gathered run
};

// Which cells are built, and of which pool.
struct ListWindow {
  ivec4 range;  // x: first cell; y: cells; z: nodes that a linked pool holds, the reserved one among them
};

// One step of a scan or a sort; the shaders say what the numbers are.
struct ListStep {
  ivec4 step;
  ivec4 more;
};

SHARED_END

// Values of LIST_PASS, which C++ defines for programs that store nodes: what storing does.
#define LIST_PASS_SPINLOCK 0  // the strategies' numbers
#define LIST_PASS_LOCKFREE 1
#define LIST_PASS_APPEND 2
#define LIST_PASS_SCATTER 3
#define LIST_PASS_COUNT 4
#define LIST_PASS_LOG 5

// A head that stands for "somebody is changing this list".
#define LIST_LOCKED 0xffffffffu
// Tries for a lock, and nodes walked in all tries, before a node goes to the overflow list. Together they keep an
// insertion far below the 65,535 loop iterations at which some drivers end every loop silently, and the time of lists
// that are longer than anyone wants to insert into from growing with the square of their length.
#ifndef LIST_SPIN_LIMIT
#define LIST_SPIN_LIMIT 2048
#endif
#ifndef LIST_WALK_LIMIT
#define LIST_WALK_LIMIT 1024
#endif

// Tallies behind the counters: lists by length (see lists::lengthClasses), the same as cursors, and insertions by
// the power of 2 of their tries.
#define LIST_LENGTH_CLASSES 34
#define LIST_SPIN_CLASSES 16
#define LIST_TALLY_LENGTHS 0
#define LIST_TALLY_CURSORS LIST_LENGTH_CLASSES
#define LIST_TALLY_SPINS (2 * LIST_LENGTH_CLASSES)
#define LIST_TALLIES (2 * LIST_LENGTH_CLASSES + LIST_SPIN_CLASSES)
#define LIST_NOT_LISTED 0xffffffffu  // a cursor of lengths whose cells need no list
// Runs up to this length are sorted in registers; of pools of several banks, whose access is longer code, the second.
#define LIST_SHORT_RUN 32
#define LIST_SHORT_RUN_IN_BANKS 8
// Cells that one invocation of the scan adds up.
#define LIST_SCAN_BLOCK 64
#define LIST_MAX_BANKS 4
