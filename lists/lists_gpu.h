// The list container on the GPU: cells, each with a run of nodes sorted by (depth, id). Shaders that include
// shaders/lists/insert.glsl store nodes in any order; shaders that include shaders/lists/runs.glsl read the
// runs. How they are built (lists/strategy.h) changes no bit of them. Nothing is lost: the demand is counted
// exactly, and cells that do not fit the budget are built in windows.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gl/buffer.h"
#include "gl/device.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "lists/sorting_network.h"
#include "lists/strategy.h"
#include "shaders/shared/lists.h"

namespace sfumato::lists {

// Cells that are built together.
struct Window {
  size_t firstCell = 0;
  size_t cells = 0;
};

// One issue of the draws and dispatches that store nodes.
struct Pass {
  gl::ShaderDefines defines;  // for every program that includes shaders/lists/insert.glsl
  Window window;              // nodes of other cells are left out by the shaders; a scissor saves their work
};
// Stores the same nodes whenever it is called, in any order; nodes of one cell and depth differ in their id.
using Draw = std::function<void(const Pass&)>;

class Lists;

// Watches containers from outside (ListOptions::observer).
class Observer {
 public:
  virtual ~Observer() = default;
  // Before and after a container takes memory.
  virtual void allocates(gl::Device& device) = 0;
  // The runs of a window's cells are there, with the nodes that `draw` stores in them.
  virtual void built(gl::Device& device, const Lists& lists, const Window& window, const Draw& draw) = 0;
};

class Lists {
 public:
  // Empty lists of up to `cells` cells. `payloadBytes` a node, a multiple of 4, may be 0. Costs 8 bytes a
  // cell and 8 + payloadBytes a node; strategies other than `count` 8 a cell and 12 + payloadBytes a node
  // more while they build.
  Lists(gl::Device& device, std::string label, size_t cells, size_t payloadBytes,
        const ListOptions& options = {});

  // Builds the lists of all cells. Throws Memory, and says how much it takes, when they do not fit at once.
  ListStatistics build(gl::Device& device, const Draw& draw);
  // The same with only the first `cells`, but nothing where they do not fit, so that the caller can try
  // fewer: fitting() says how many. Throws Memory under OnOverflow::Error.
  std::optional<ListStatistics> tryBuild(gl::Device& device, size_t cells, const Draw& draw);
  size_t fitting() const { return fitting_; }
  // Builds all cells in windows, one where they fit at once and are no more than `mostCells`, and calls
  // `consume` after each with the cells that the runs are of: runs are numbered from the window's first cell.
  // Throws Memory when one cell alone does not fit, or, under OnOverflow::Error, when a window does not.
  ListStatistics buildWindows(gl::Device& device, const Draw& draw,
                              const std::function<void(const Window&)>& consume,
                              size_t mostCells = std::numeric_limits<size_t>::max());

  // Of some cells of the window that was built last, the first one being its first; in consume().
  size_t nodesOf(const Window& cells) const;

  // For comparisons: the linked lists of all cells as spin locks sorted them, and no runs. The pool holds
  // `nodes`; where that is too few, what they are is known after one build, and they are built again. Costs 8
  // bytes a cell and 12 + payloadBytes a node. Returns the nodes. Throws Memory when the device holds fewer.
  size_t buildLinked(gl::Device& device, size_t nodes, const Draw& draw);
  // For shaders, at these texture units: heads (R32UI), links (ListLink, RGB32UI), payloads (pairs of words).
  void bindLinked(unsigned heads, unsigned links, unsigned payloads) const;
  const gl::Buffer& heads() const { return heads_; }

  // Nodes that `draw` will store in the first `cells`, by a count pass: nothing is stored.
  size_t predict(gl::Device& device, size_t cells, const Draw& draw);

  // For shaders that include shaders/lists/runs.glsl, at these texture units.
  void bind(unsigned runs, unsigned keys, unsigned payloads) const;

  const std::string& label() const { return label_; }
  size_t cells() const { return cells_; }  // at most
  // As many from now on; memory is kept.
  void setCells(size_t cells) { cells_ = cells; }
  size_t payloadBytes() const { return payloadBytes_; }

  // Read back, for checks on the CPU.
  std::vector<shared::ListRun> readRuns() const;  // of the cells that were built last
  std::vector<shared::ListKey> readKeys() const;
  // `words` of each node, each payloadBytes / 4 in a row.
  std::vector<uint32_t> readPayloads() const;

 private:
  // What the scan over the counts of all cells told.
  struct Counted {
    shared::ListCounters counters{};
    std::vector<uint32_t> tallies;
  };
  // Runs of more than `shorter` and up to `length` nodes: `count` from place `first` in sortedCells_, or,
  // where that is -1, some of `count` cells.
  struct RunsOfALength {
    int first;
    size_t count;
    size_t shorter;
    size_t length;
  };
  enum class RunOffset { BeforeItsNodes, BehindItsNodes };
  enum class Stored { All, PoolTooSmall, NotAll };

  size_t payloadWords() const { return payloadBytes_ / 4; }
  bool linked() const { return strategy_ != Strategy::Count; }
  size_t bankBytes(const gl::Device& device) const;
  size_t nodesInOneBank(const gl::Device& device) const;
  size_t mostNodes(const gl::Device& device) const;  // that all banks hold
  size_t bytesFor(size_t cells, size_t nodes) const;
  size_t nodesAllowed(const gl::Device& device, size_t cells) const;  // by budget and device
  size_t allocatedBytes() const;
  void release();
  void releaseNodes();
  void reserveCells(gl::Device& device, size_t cells);
  void reserveNodes(gl::Device& device, size_t nodes);

  gl::ShaderDefines bankDefines(const gl::Device& device) const;
  gl::ShaderDefines poolDefines(const gl::Device& device) const;
  void bindNodes(const gl::Device& device, unsigned binding, const gl::Buffer& buffer, size_t bytes) const;
  void bindPool(const gl::Device& device) const;
  void useWindow(const Window& window);
  void useStep(const shared::ListStep& step);

  Counted countNodes(gl::Device& device, const Window& window, const Draw& draw);
  Counted scan(gl::Device& device, size_t cells, RunOffset offset);
  size_t cellsHolding(size_t cells, size_t nodes) const;  // of the first cells, by their scanned counts
  size_t mostCells() const;
  size_t cellsToTry(const gl::Device& device, size_t built, size_t stored) const;
  bool countsFirst() const;
  bool limited() const;
  size_t buildPrefix(gl::Device& device, Window window, const Draw& draw, bool wholly, bool count,
                     ListStatistics& statistics);
  void useStrategy(Strategy strategy);
  Stored scatter(gl::Device& device, const Window& window, const Draw& draw);
  Stored link(gl::Device& device, const Window& window, const Draw& draw, Counted& counted, bool& sorted);
  bool unfinished();
  size_t shortRun(const gl::Device& device) const;
  void sort(gl::Device& device, size_t cells, const Counted& counted);
  std::vector<uint32_t> listSortedCells(gl::Device& device, size_t cells, const Counted& counted);
  void sortRuns(gl::Device& device, const RunsOfALength& runs);
  const gl::Program& sortProgram(gl::Device& device, size_t size, const Network& network) const;
  [[noreturn]] void failOverBudget(gl::Device& device, size_t cells) const;

  std::string label_;
  size_t cells_;
  size_t payloadBytes_;
  ListOptions options_;
  Strategy strategy_;
  size_t reservedCells_ = 0;
  size_t capacity_ = 0;    // nodes that the pools hold
  size_t fitting_ = 0;     // cells, of the last build that did not fit
  size_t unmetNodes_ = 0;  // of it
  size_t builtCells_ = 0;
  size_t builtNodes_ = 0;
  gl::Buffer runs_;
  gl::Buffer sums_;  // of the scan
  gl::Buffer keys_;
  gl::Buffer payloads_;
  gl::Buffer heads_;  // linked strategies: heads, then those of the overflow lists
  gl::Buffer links_;
  gl::Buffer linkedPayloads_;
  gl::Buffer sortedCells_;  // cells by the length of their runs
  gl::Buffer counters_;     // ListCounters, then the tallies
  gl::Buffer window_;
  gl::Buffer step_;
  gl::BufferTexture runsView_;
  gl::BufferTexture keysView_;
  gl::BufferTexture payloadsView_;
  gl::BufferTexture linksView_;
  gl::BufferTexture linkedPayloadsView_;
  gl::BufferTexture headsView_;  // of buildLinked alone
};

// The strategy for a device, which has not been found unsafe there (lists/driver_verdict.h): see
// docs/how_it_works.md for the rule and the figures behind it. Throws NoGl when all have.
Strategy chooseStrategy(const gl::Device& device);

}  // namespace sfumato::lists
