#include "lists/lists_gpu.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "base/error.h"
#include "base/size_text.h"
#include "gl/commands.h"
#include "lists/driver_verdict.h"
#include "lists/list_bytes.h"
#include "lists/sorting_network.h"
#include "shaders/shared/bindings.h"

namespace sfumato::lists {

using gl::Profiler;
using shared::ListCounters;
using shared::ListKey;
using shared::ListLink;
using shared::ListRun;
using shared::ListStep;
using shared::ListWindow;

namespace {

constexpr size_t smallestSort = 4;  // nodes; a run of 2 is sorted as one of 4

size_t sumOf(const std::vector<size_t>& values) {
  size_t sum = 0;
  for (const size_t value : values) sum += value;
  return sum;
}

// Tries that 99 % of `insertions` did not exceed, from the tallies of those that took more than one.
size_t p99Of(std::span<const uint32_t> spins, size_t insertions) {
  if (insertions == 0) return 0;
  size_t above = insertions / 100;
  for (size_t i = spins.size(); i-- > 0;) {
    if (spins[i] > above) return size_t{2} << i;
    above -= spins[i];
  }
  return 1;
}

}  // namespace

Lists::Lists(gl::Device& device, std::string label, size_t cells, size_t payloadBytes,
             const ListOptions& options)
    : label_(std::move(label)),
      cells_(cells),
      payloadBytes_(payloadBytes),
      options_(options),
      strategy_(options.strategy),
      counters_(device, label_, sizeof(ListCounters) + LIST_TALLIES * sizeof(uint32_t)),
      window_(device, label_, sizeof(ListWindow)),
      step_(device, label_, sizeof(ListStep)) {
  if (options_.observer) options_.observer->allocates(device);
}

// ---- What it costs

size_t Lists::bankBytes(const gl::Device& device) const {
  const auto block = static_cast<size_t>(device.limits().storageBlockBytes);
  return options_.bankBytes == 0 ? block : std::min(options_.bankBytes, block);
}

size_t Lists::nodesInOneBank(const gl::Device& device) const {
  return bankBytes(device) / std::max({sizeof(ListKey), linked() ? sizeof(ListLink) : 0, payloadBytes_});
}

size_t Lists::mostNodes(const gl::Device& device) const {
  const size_t readable =
      static_cast<size_t>(device.limits().textureBufferTexels) / std::max<size_t>(payloadWords(), 1);
  const size_t banked = LIST_MAX_BANKS * std::bit_floor(nodesInOneBank(device));
  return std::min(readable, std::max(nodesInOneBank(device), banked)) - 1;  // a linked pool reserves one
}

size_t Lists::bytesFor(size_t cells, size_t nodes) const {
  return bytesOfLists(strategy_, cells, nodes, payloadBytes_);
}

size_t Lists::nodesAllowed(const gl::Device& device, size_t cells) const {
  const size_t most = mostNodes(device);
  if (!limited()) return most;
  const size_t fixed = bytesFor(cells, 0);
  if (fixed >= options_.budgetBytes) return 0;
  // With a cell number for every so many nodes.
  const size_t parts = LIST_SHORT_RUN_IN_BANKS + 1;
  return std::min(most, (options_.budgetBytes - fixed) * parts /
                            (bytesOfNode(strategy_, payloadBytes_) * parts + sizeof(uint32_t)));
}

size_t Lists::allocatedBytes() const {
  size_t bytes = 0;
  for (const gl::Buffer* buffer : {&runs_, &sums_, &keys_, &payloads_, &heads_, &links_, &linkedPayloads_,
                                   &sortedCells_, &counters_, &window_, &step_})
    bytes += buffer->bytes();
  return bytes;
}

void Lists::reserveCells(gl::Device& device, size_t cells) {
  if (cells <= reservedCells_) return;
  if (limited() && bytesFor(cells, capacity_) > options_.budgetBytes) releaseNodes();
  runs_ = gl::Buffer();
  sums_ = gl::Buffer();
  heads_ = gl::Buffer();
  runs_ = gl::Buffer(device, label_, cells * sizeof(ListRun));
  sums_ = gl::Buffer(device, label_, sumOf(scanLevels(cells)) * sizeof(uint32_t));
  if (linked()) heads_ = gl::Buffer(device, label_, cells * 2 * sizeof(uint32_t));
  runsView_ = gl::BufferTexture(device, runs_, gl::BufferFormat::RG32UI);
  reservedCells_ = cells;
}

void Lists::releaseNodes() {
  for (gl::Buffer* buffer : {&keys_, &payloads_, &links_, &linkedPayloads_, &sortedCells_})
    *buffer = gl::Buffer();
  capacity_ = 0;
}

void Lists::reserveNodes(gl::Device& device, size_t nodes) {
  if (nodes <= capacity_ && keys_.bytes() > 0) return;
  // A little more than now, so that the next window or frame fits as well.
  const size_t wanted = std::min(nodes + nodes / 16, std::max(nodes, nodesAllowed(device, reservedCells_)));
  releaseNodes();  // the old pool goes before the new one comes
  capacity_ = wanted;
  const auto pool = [&](size_t count, size_t bytes) {
    return gl::Buffer(device, label_, count * bytes, gl::Buffer::Whole::Never);
  };
  keys_ = pool(capacity_, sizeof(ListKey));
  keysView_ = gl::BufferTexture(device, keys_, gl::BufferFormat::RG32UI);
  payloads_ = pool(capacity_, payloadBytes_);
  payloadsView_ = gl::BufferTexture(
      device, payloads_, payloadWords() % 2 == 0 ? gl::BufferFormat::RG32UI : gl::BufferFormat::R32UI);
  if (!linked()) return;
  links_ = pool(capacity_ + 1, sizeof(ListLink));
  linksView_ = gl::BufferTexture(device, links_, gl::BufferFormat::RGB32UI);
  linkedPayloads_ = pool(capacity_ + 1, payloadBytes_);
  linkedPayloadsView_ = gl::BufferTexture(device, linkedPayloads_, gl::BufferFormat::R32UI);
}

// ---- What the shaders are told

gl::ShaderDefines Lists::bankDefines(const gl::Device& device) const {
  if (capacity_ + 1 <= nodesInOneBank(device)) return {};
  return {{"LIST_BANKS", std::to_string(LIST_MAX_BANKS)},
          {"LIST_BANK_SHIFT", std::to_string(std::bit_width(nodesInOneBank(device)) - 1)}};
}

gl::ShaderDefines Lists::poolDefines(const gl::Device& device) const {
  gl::ShaderDefines defines = bankDefines(device);
  defines.emplace_back("PAYLOAD_WORDS", std::to_string(payloadWords()));
  return defines;
}

void Lists::bindNodes(const gl::Device& device, unsigned binding, const gl::Buffer& buffer,
                      size_t bytes) const {
  if (bankDefines(device).empty()) {
    buffer.bindStorage(binding);
    return;
  }
  const size_t bank = std::bit_floor(nodesInOneBank(device)) * bytes;
  for (unsigned i = 0; i < LIST_MAX_BANKS; ++i) {
    // A bank that is not there is never asked for.
    const size_t first = i * bank < buffer.bytes() ? i * bank : 0;
    buffer.bindStorageRange(binding + i, first, std::min(bank, buffer.bytes() - first));
  }
}

void Lists::useWindow(const Window& window) {
  window_.writeValue(ListWindow{{static_cast<int>(window.firstCell), static_cast<int>(window.cells),
                                 static_cast<int>(capacity_ + 1), 0}});
  window_.bindUniform(UNIFORM_LISTS);
  runs_.bindStorage(STORAGE_LIST_RUNS);
  counters_.bindStorage(STORAGE_LIST_COUNTERS);
}

void Lists::useStep(const ListStep& step) {
  step_.writeValue(step);
  step_.bindUniform(UNIFORM_LIST_STEP);
}

void Lists::bindPool(const gl::Device& device) const {
  bindNodes(device, STORAGE_LIST_NODES, keys_, sizeof(ListKey));
  if (payloadBytes_ > 0) bindNodes(device, STORAGE_LIST_PAYLOADS, payloads_, payloadBytes_);
}

// ---- Counting

Lists::Counted Lists::countNodes(gl::Device& device, const Window& window, const Draw& draw) {
  const Profiler::Scope time(device.profiler(), "count");
  counters_.clear();
  runs_.clear();
  useWindow(window);
  draw({{{"LIST_PASS", "LIST_PASS_COUNT"}}, window});
  gl::storageBarrier();
  return scan(device, window.cells, RunOffset::BehindItsNodes);
}

Lists::Counted Lists::scan(gl::Device& device, size_t cells, RunOffset offset) {
  const gl::ShaderDefines ofCells = {{"SCAN_CELLS", "1"}};
  const std::vector<size_t> levels = scanLevels(cells);
  counters_.bindStorage(STORAGE_LIST_COUNTERS);
  runs_.bindStorage(STORAGE_LIST_RUNS);
  sums_.bindStorage(STORAGE_LIST_SUMS);
  std::vector<int> places = {0};
  for (const size_t level : levels) places.push_back(places.back() + static_cast<int>(level));
  const auto step = [&](const char* shader, const gl::ShaderDefines& defines, size_t count, int place,
                        int sums) {
    useStep({{static_cast<int>(count), place, sums, offset == RunOffset::BehindItsNodes}, glm::ivec4(0)});
    gl::dispatchLinear(device.program({shader}, defines), scanBlocks(count));
    gl::storageBarrier();
  };
  step("lists/scan_sums.comp", ofCells, cells, 0, 0);
  for (size_t i = 1; i < levels.size(); ++i)
    step("lists/scan_sums.comp", {}, levels[i - 1], places[i - 1], places[i]);
  step("lists/scan_offsets.comp", {}, levels.back(), places[levels.size() - 1], -1);
  for (size_t i = levels.size() - 1; i-- > 0;)
    step("lists/scan_offsets.comp", {}, levels[i], places[i], places[i + 1]);
  step("lists/scan_offsets.comp", ofCells, cells, 0, 0);

  Counted counted;
  counted.counters = counters_.readValue<ListCounters>();
  counted.tallies.resize(LIST_TALLIES);
  counters_.read(std::as_writable_bytes(std::span(counted.tallies)), sizeof(ListCounters));
  return counted;
}

size_t Lists::cellsHolding(size_t cells, size_t nodes) const {
  const auto runs = runs_.readValues<ListRun>(cells);
  const auto beyond = std::upper_bound(runs.begin(), runs.end(), nodes,
                                       [](size_t most, const ListRun& run) { return most < run.first; });
  return static_cast<size_t>(beyond - runs.begin());
}

size_t Lists::predict(gl::Device& device, size_t cells, const Draw& draw) {
  reserveCells(device, cells);
  return countNodes(device, {0, cells}, draw).counters.total;
}

// ---- Building

// How many of the window's first cells were built; with `wholly` all or none. The linked strategies count
// first when `count` says so.
size_t Lists::buildPrefix(gl::Device& device, Window window, const Draw& draw, bool wholly, bool count,
                          ListStatistics& statistics) {
  const bool tooManyCells = window.cells > 1 && limited() && bytesFor(window.cells, 0) > options_.budgetBytes;
  if (tooManyCells && options_.onOverflow == OnOverflow::Window) {
    fitting_ = mostCells();  // whatever they hold
    return 0;
  }
  reserveCells(device, window.cells);
  Counted counted;
  if (count) {
    counted = countNodes(device, window, draw);
    ++statistics.builds;
    const size_t allowed = nodesAllowed(device, reservedCells_);
    if (counted.counters.total > allowed || tooManyCells) {
      unmetNodes_ = counted.counters.total;
      window.cells = cellsHolding(window.cells, allowed);
      fitting_ = window.cells;
      if (window.cells == 0 || wholly) return 0;
      counters_.clear();
      counted = scan(device, window.cells, RunOffset::BehindItsNodes);
    }
    statistics.predicted = counted.counters.total;
    statistics.predictedBytes = bytesFor(reservedCells_, statistics.predicted);
    reserveNodes(device, statistics.predicted);
  }
  if (options_.observer) options_.observer->allocates(device);
  const bool nothing = !linked() && counted.counters.total == 0;
  bool sorted = nothing;
  const Stored stored = nothing    ? Stored::All
                        : linked() ? link(device, window, draw, counted, sorted)
                                   : scatter(device, window, draw);
  if (!nothing) ++statistics.builds;
  if (stored == Stored::PoolTooSmall) return buildPrefix(device, window, draw, wholly, true, statistics);
  if (stored == Stored::NotAll) {
    // What lost nodes once is not used again.
    ++statistics.distrusted;
    if (statistics.distrusted == 3)
      base::fail(base::ExitCode::CheckFailed,
                 "{}: every strategy loses nodes on this device: choose another one with --device", label_);
    useStrategy(linked() ? Strategy::Count : Strategy::Append);
    return buildPrefix(device, window, draw, wholly, true, statistics);
  }
  if (!sorted) sort(device, window.cells, counted);

  builtCells_ = window.cells;
  builtNodes_ = counted.counters.total;
  statistics.strategy = strategy_;
  statistics.cells = window.cells;
  statistics.demand = linked() ? counted.counters.demand : counted.counters.total;
  statistics.stored = counted.counters.total;
  statistics.longest = counted.counters.longest;
  std::copy_n(counted.tallies.begin(), lengthClasses, statistics.lengths.begin());
  statistics.overflowed = counted.counters.overflowed;
  statistics.maxSpins = std::max(counted.counters.maxSpins, std::min(counted.counters.demand, 1u));
  statistics.p99Spins =
      p99Of(std::span(counted.tallies).subspan(LIST_TALLY_SPINS, LIST_SPIN_CLASSES), counted.counters.demand);
  statistics.retries = counted.counters.retries;
  statistics.windows = 1;
  statistics.capacity = capacity_;
  statistics.nodeBytes = sizeof(ListKey) + payloadBytes_;
  statistics.bytes = allocatedBytes();
  if (options_.observer) options_.observer->built(device, *this, window, draw);
  return window.cells;
}

void Lists::useStrategy(Strategy strategy) {
  strategy_ = strategy;
  release();
}

void Lists::release() {
  for (gl::Buffer* buffer : {&runs_, &sums_, &heads_}) *buffer = gl::Buffer();
  reservedCells_ = 0;
  releaseNodes();
}

Lists::Stored Lists::scatter(gl::Device& device, const Window& window, const Draw& draw) {
  const Profiler::Scope time(device.profiler(), "scatter");
  useWindow(window);
  bindPool(device);
  gl::ShaderDefines defines = bankDefines(device);
  defines.emplace_back("LIST_PASS", "LIST_PASS_SCATTER");
  draw({defines, window});
  gl::storageBarrier();
  useWindow(window);
  gl::dispatchLinear(device.program({"lists/check_runs.comp"}), window.cells);
  gl::storageBarrier();
  return counters_.readValue<ListCounters>().broken == 0 ? Stored::All : Stored::NotAll;
}

// Linked lists, then the runs that hold their nodes; `counted` tells of these. `sorted` says whether they
// ascend.
Lists::Stored Lists::link(gl::Device& device, const Window& window, const Draw& draw, Counted& counted,
                          bool& sorted) {
  {
    const Profiler::Scope time(device.profiler(), "link");
    counters_.clear();
    heads_.clear();
    useWindow(window);
    heads_.bindStorage(STORAGE_LIST_HEADS);
    bindNodes(device, STORAGE_LIST_NODES, links_, sizeof(ListLink));
    if (payloadBytes_ > 0) bindNodes(device, STORAGE_LIST_PAYLOADS, linkedPayloads_, payloadBytes_);
    gl::ShaderDefines defines = bankDefines(device);
    defines.emplace_back("LIST_PASS", std::to_string(static_cast<int>(strategy_)));
    draw({defines, window});
    gl::storageBarrier();
    if (counters_.readValue<ListCounters>().demand > capacity_) return Stored::PoolTooSmall;
  }
  const Profiler::Scope time(device.profiler(), "gather");
  useWindow(window);
  heads_.bindStorage(STORAGE_LIST_HEADS);
  bindNodes(device, STORAGE_LIST_NODES, links_, sizeof(ListLink));
  const gl::Program& walk = device.program({"lists/walk.comp"}, bankDefines(device));
  for (int first = 1; first == 1 || unfinished(); first = 0) {
    useStep({{first, 0, 0, 0}, glm::ivec4(0)});
    gl::dispatchLinear(walk, window.cells);
    gl::storageBarrier();
  }
  counted = scan(device, window.cells, RunOffset::BeforeItsNodes);
  if (counted.counters.broken > 0 || counted.counters.total != counted.counters.demand) return Stored::NotAll;

  bindPool(device);
  heads_.bindStorage(STORAGE_LIST_HEADS);
  linksView_.bind(TEXTURE_LIST_LINKS);
  linkedPayloadsView_.bind(TEXTURE_LIST_LINKED_PAYLOADS);
  const gl::Program& gather = device.program({"lists/gather.comp"}, poolDefines(device));
  do {
    gl::dispatchLinear(gather, window.cells);
    gl::storageBarrier();
  } while (unfinished());
  sorted = counters_.readValue<ListCounters>().unsorted == 0;
  return Stored::All;
}

size_t Lists::buildLinked(gl::Device& device, size_t nodes, const Draw& draw) {
  const Profiler::Scope time(device.profiler(), "link");
  base::check(strategy_ == Strategy::SpinLock && payloadBytes_ % 8 == 0, "linked lists are read as they are");
  const size_t headBytes = cells_ * 2 * sizeof(uint32_t);
  if (heads_.bytes() == 0) {
    heads_ = gl::Buffer(device, label_, headBytes);
    headsView_ = gl::BufferTexture(device, heads_, gl::BufferFormat::R32UI);
    runs_ = gl::Buffer(device, label_, sizeof(ListRun));
  }
  int attempts = 8;
  for (capacity_ = std::max(nodes, capacity_);;) {
    if (capacity_ > mostNodes(device)) failOverBudget(device, cells_);
    if (links_.bytes() < (capacity_ + 1) * sizeof(ListLink)) {
      links_ = gl::Buffer(device, label_, (capacity_ + 1) * sizeof(ListLink), gl::Buffer::Whole::Never);
      linksView_ = gl::BufferTexture(device, links_, gl::BufferFormat::RGB32UI);
      linkedPayloads_ = gl::Buffer(device, label_, (capacity_ + 1) * payloadBytes_, gl::Buffer::Whole::Never);
      linkedPayloadsView_ = gl::BufferTexture(device, linkedPayloads_, gl::BufferFormat::RG32UI);
    }
    counters_.clear();
    heads_.clear();
    useWindow({0, cells_});
    heads_.bindStorage(STORAGE_LIST_HEADS);
    bindNodes(device, STORAGE_LIST_NODES, links_, sizeof(ListLink));
    if (payloadBytes_ > 0) bindNodes(device, STORAGE_LIST_PAYLOADS, linkedPayloads_, payloadBytes_);
    gl::ShaderDefines defines = bankDefines(device);
    defines.emplace_back("LIST_PASS", std::to_string(static_cast<int>(strategy_)));
    draw({defines, {0, cells_}});
    gl::storageBarrier();
    const auto counters = counters_.readValue<ListCounters>();
    if (counters.demand > capacity_) {
      capacity_ = unmetNodes_ = counters.demand;
    } else if (counters.overflowed == 0) {
      return counters.demand;
    } else {
      // A lane waited for a lock for longer than is bounded: a driver's scheduling, another time it does not.
      base::check(--attempts > 0, "linked lists take every node in one of some attempts");
    }
  }
}

void Lists::bindLinked(unsigned heads, unsigned links, unsigned payloads) const {
  headsView_.bind(heads);
  linksView_.bind(links);
  if (payloadBytes_ > 0) linkedPayloadsView_.bind(payloads);
}

// Whether the last dispatch left work; the next one starts to count anew.
bool Lists::unfinished() {
  auto counters = counters_.readValue<ListCounters>();
  if (counters.unfinished == 0) return false;
  counters.unfinished = 0;
  counters_.writeValue(counters);
  return true;
}

// ---- Sorting

// Runs by length, up to a power of 2, so that none waits for what a longer one has to do.
void Lists::sort(gl::Device& device, size_t cells, const Counted& counted) {
  const Profiler::Scope time(device.profiler(), "sort");
  useWindow({0, cells});
  bindPool(device);
  const std::vector<uint32_t> firsts = listSortedCells(device, cells, counted);
  sortedCells_.bindStorage(STORAGE_LIST_SUMS);
  size_t shorter = 1;
  for (size_t i = 2; i < lengthClasses; ++i) {
    const size_t length = size_t{1} << (i - 1);
    const bool listed = firsts[i] != LIST_NOT_LISTED;
    const size_t runs = listed ? counted.tallies[i] : cells;
    if (counted.tallies[i] > 0)
      sortRuns(device, {listed ? static_cast<int>(firsts[i]) : -1, runs, shorter, length});
    shorter = length;
  }
}

// Lists the cells of each length that few or only long runs have. Returns the place of each length's first.
std::vector<uint32_t> Lists::listSortedCells(gl::Device& device, size_t cells, const Counted& counted) {
  std::vector<uint32_t> firsts(lengthClasses, LIST_NOT_LISTED);
  uint32_t listed = 0;
  for (size_t i = 2; i < firsts.size(); ++i) {
    const bool isLong = (size_t{1} << (i - 1)) > shortRun(device);
    if (counted.tallies[i] == 0 || (!isLong && counted.tallies[i] > cells / 8)) continue;
    firsts[i] = listed;
    listed += counted.tallies[i];
  }
  if (sortedCells_.bytes() < std::max<size_t>(listed, 1) * sizeof(uint32_t)) {
    sortedCells_ = gl::Buffer();
    sortedCells_ = gl::Buffer(device, label_, listed * sizeof(uint32_t));
  }
  if (listed == 0) return firsts;
  counters_.write(std::as_bytes(std::span(firsts)),
                  sizeof(ListCounters) + LIST_TALLY_CURSORS * sizeof(uint32_t));
  sortedCells_.bindStorage(STORAGE_LIST_SUMS);
  gl::dispatchLinear(device.program({"lists/sorted_cells.comp"}), cells);
  gl::storageBarrier();
  return firsts;
}

void Lists::sortRuns(gl::Device& device, const RunsOfALength& runs) {
  const auto step = [&](const gl::Program& program, size_t invocations, size_t block, size_t distance) {
    useStep({{runs.first, static_cast<int>(runs.count), static_cast<int>(block), static_cast<int>(distance)},
             {static_cast<int>(runs.length), static_cast<int>(runs.shorter), 0, 0}});
    gl::dispatchLinear(program, runs.count * invocations);
    gl::storageBarrier();
  };
  const size_t piece = shortRun(device);
  const size_t size = std::clamp(runs.length, smallestSort, piece);
  step(sortProgram(device, size, sortingNetwork(static_cast<int>(size))),
       std::max(runs.length / size, size_t{1}), size, 0);
  if (runs.length <= piece) return;
  // Sorted pieces of a long run are merged, pairs of them at a time.
  const gl::Program& merge = sortProgram(device, piece, mergingNetwork(static_cast<int>(piece)));
  const gl::Program& exchange = device.program({"lists/exchange.comp"}, poolDefines(device));
  for (size_t block = 2 * piece; block <= runs.length; block *= 2) {
    step(exchange, runs.length / 2, block, 0);
    for (size_t distance = block / 4; distance >= piece; distance /= 2)
      step(exchange, runs.length / 2, block, distance);
    step(merge, runs.length / piece, block, 1);
  }
}

// Nodes that one invocation sorts.
size_t Lists::shortRun(const gl::Device& device) const {
  return bankDefines(device).empty() ? LIST_SHORT_RUN : LIST_SHORT_RUN_IN_BANKS;
}

const gl::Program& Lists::sortProgram(gl::Device& device, size_t size, const Network& network) const {
  gl::ShaderDefines defines = poolDefines(device);
  defines.emplace_back("LIST_SORT_SIZE", std::to_string(size));
  defines.emplace_back("LIST_NETWORK", networkText(network));
  defines.emplace_back("LIST_EACH", elementsText(static_cast<int>(size)));
  return device.program({"lists/sort.comp"}, defines);
}

// ---- The ways in

std::optional<ListStatistics> Lists::tryBuild(gl::Device& device, size_t cells, const Draw& draw) {
  ListStatistics statistics;
  fitting_ = 0;
  unmetNodes_ = 0;
  if (buildPrefix(device, {0, cells}, draw, true, countsFirst(), statistics) == cells) return statistics;
  if (options_.onOverflow == OnOverflow::Error) failOverBudget(device, cells);
  return std::nullopt;
}

ListStatistics Lists::build(gl::Device& device, const Draw& draw) {
  if (const auto statistics = tryBuild(device, cells_, draw)) return *statistics;
  failOverBudget(device, cells_);
}

ListStatistics Lists::buildWindows(gl::Device& device, const Draw& draw,
                                   const std::function<void(const Window&)>& consume, size_t mostCells) {
  const bool wholly = options_.onOverflow == OnOverflow::Error;
  if (limited() && !wholly) mostCells = std::min(mostCells, this->mostCells());
  ListStatistics all;
  size_t tried = mostCells;
  for (size_t first = 0; first < cells_;) {
    ListStatistics statistics;
    const Window window{first, std::min(tried, cells_ - first)};
    const size_t built = buildPrefix(device, window, draw, wholly, countsFirst(), statistics);
    if (built == 0) {
      if (wholly || reservedCells_ == 1) failOverBudget(device, window.cells);
      // Memory for many cells may be what the first of them lacks.
      release();
      tried = 1;
      continue;
    }
    all += statistics;
    consume({first, built});
    first += built;
    tried = std::min(mostCells, cellsToTry(device, built, statistics.stored));
  }
  return all;
}

// After a window of `built` cells with `stored` nodes: what fits if those that follow are as full, and a
// quarter more. Cells that do not fit are counted in vain, too small a window issues the draws once more.
size_t Lists::cellsToTry(const gl::Device& device, size_t built, size_t stored) const {
  const double fitting = static_cast<double>(built) *
                         static_cast<double>(nodesAllowed(device, reservedCells_)) /
                         static_cast<double>(std::max<size_t>(stored, 1));
  return static_cast<size_t>(std::min(1.25 * fitting, 1e15)) + 1;
}

// Of a window: no more than half of the budget for what every cell takes.
size_t Lists::mostCells() const {
  const size_t perCell = bytesOfCells(strategy_, LIST_SCAN_BLOCK) / LIST_SCAN_BLOCK + 1;
  return std::max<size_t>(options_.budgetBytes / (2 * perCell), 1);
}

// Whether a count pass comes before the nodes are stored: always for `count`; for linked lists when the size
// of their pool is unknown, or must not be exceeded.
bool Lists::countsFirst() const {
  return !linked() || capacity_ == 0 || limited();
}

// Whether there is a budget to be held.
bool Lists::limited() const {
  return options_.budgetBytes != 0 && options_.onOverflow != OnOverflow::Grow;
}

void Lists::failOverBudget(gl::Device& device, size_t cells) const {
  const size_t nodes = cells == 1 ? runs_.readValue<ListRun>().count : unmetNodes_;
  const std::string what = cells == 1 ? "one cell alone holds" : fmt::format("{} cells hold", cells);
  const std::string needed = base::sizeText(bytesFor(cells, nodes));
  if (nodes > mostNodes(device))
    base::fail(base::ExitCode::Memory,
               "{}: {} {} nodes, which take {}, more than this device allows: lower the resolution", label_,
               what, nodes, needed);
  base::fail(base::ExitCode::Memory,
             "{}: {} {} nodes, which take {}, the budget is {}: raise --list-memory{}", label_, what, nodes,
             needed, base::sizeText(options_.budgetBytes),
             options_.onOverflow == OnOverflow::Error ? " or use --on-overflow window" : "");
}

// ---- Reading

void Lists::bind(unsigned runs, unsigned keys, unsigned payloads) const {
  runsView_.bind(runs);
  keysView_.bind(keys);
  if (payloadBytes_ > 0) payloadsView_.bind(payloads);
}

size_t Lists::nodesOf(const Window& cells) const {
  const auto run = [&](size_t cell) {
    ListRun value{};
    runs_.read(std::as_writable_bytes(std::span(&value, 1)), cell * sizeof(ListRun));
    return value;
  };
  const ListRun last = run(cells.firstCell + cells.cells - 1);
  return last.first + last.count - run(cells.firstCell).first;
}

std::vector<ListRun> Lists::readRuns() const {
  return runs_.readValues<ListRun>(builtCells_);
}

std::vector<ListKey> Lists::readKeys() const {
  return keys_.readValues<ListKey>(builtNodes_);
}

std::vector<uint32_t> Lists::readPayloads() const {
  return payloads_.readValues<uint32_t>(builtNodes_ * payloadWords());
}

Strategy chooseStrategy(const gl::Device& device) {
  const gl::DeviceNames& names = device.names();
  const auto verdict = loadVerdict({names.vendor, names.renderer, names.version});
  for (const Strategy strategy : {Strategy::Count, Strategy::Append, Strategy::LockFree, Strategy::SpinLock})
    if (!verdict || verdict->trusted(strategies().nameOf(strategy))) return strategy;
  base::fail(base::ExitCode::NoGl,
             "{}: `sfumato validate` found that it builds no lists right: choose another --device, or one of "
             "--lists all the same",
             names.renderer);
}

}  // namespace sfumato::lists
