// How lists are built and what they may cost, as plain values.
#pragma once

#include <array>
#include <cstddef>

#include "base/choice.h"

namespace sfumato::lists {

// Four ways to the same runs, bit for bit.
enum class Strategy {
  SpinLock,  // sorted insertion into linked lists under a lock on the cell's head (Lindbeck 2015, 2.2.2)
  LockFree,  // sorted insertion by compare-and-swap (Harris 2001, without its deletion)
  Append,    // push to the front with one exchange (Yang et al. 2010), sorted afterwards
  Count,     // count, scan, scatter: every node goes to its run at once; draws are issued twice
};

// What happens when the lists of all cells need more than the budget.
enum class OnOverflow {
  Grow,    // the pool grows past the budget, up to what the device allows
  Window,  // cells are built and consumed in parts that fit
  Error,   // an error that says how much is needed
};

class Observer;  // lists/lists_gpu.h

struct ListOptions {
  Strategy strategy = Strategy::Count;
  // Of everything that one list container holds at its peak; 0: what the device allows.
  size_t budgetBytes = 0;
  OnOverflow onOverflow = OnOverflow::Window;
  // Pools are split over banks of at most this size; 0: the device's limit of one storage block.
  size_t bankBytes = 0;
  // Is told of everything that is built, for tests; none: nullptr. Must outlive the lists.
  Observer* observer = nullptr;
};

const base::Choice<Strategy>& strategies();          // "spinlock", "lockfree", "append", "count"
const base::Choice<OnOverflow>& overflowPolicies();  // "grow", "window", "error"

// Lists by length: class 0 is empty, class 1 one node, class k > 1 up to 2^(k-1) nodes and more than half.
constexpr size_t lengthClasses = 34;

// What building lists took. Figures of windows, and of containers, are joined with +=.
struct ListStatistics {
  Strategy strategy = Strategy::Count;
  size_t cells = 0;
  size_t demand = 0;     // nodes asked for; all of them are stored
  size_t stored = 0;     // nodes found in the runs
  size_t predicted = 0;  // nodes that a count pass told before any was stored; 0: none was needed
  size_t hidden = 0;     // stored nodes behind the opaque depth, where the builder looked for them
  size_t longest = 0;    // nodes of the longest list
  std::array<size_t, lengthClasses> lengths{};  // lists in each class
  size_t overflowed = 0;                        // nodes that took the fallback of a bounded loop
  size_t maxSpins = 0;                          // most tries that one insertion took
  size_t p99Spins = 0;        // tries that 99 % of the insertions did not exceed, up to a factor of 2
  size_t retries = 0;         // tries beyond each insertion's first
  int windows = 0;            // parts that the cells were built in, one after the other
  int builds = 0;             // times that the draws were issued
  int distrusted = 0;         // builds that a strategy lost nodes in, and that were done again by `count`
  size_t capacity = 0;        // nodes that the pool holds
  size_t nodeBytes = 0;       // a node, in the runs
  size_t predictedBytes = 0;  // of the largest window, from `predicted`
  size_t bytes = 0;           // most that was allocated at one time

  ListStatistics& operator+=(const ListStatistics& other);
};

}  // namespace sfumato::lists
