// Checks of linked lists, built in every way that list code uses, and walked on the CPU afterwards.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <optional>

#include "base/hash.h"
#include "gl/commands.h"
#include "gl/texture.h"
#include "lists/validation/probe_gpu.h"

namespace sfumato::lists::validation {
namespace {

using base::hash;

constexpr uint32_t canary = 0xdeadbeefu;
constexpr uint32_t canaryWords = 1024;

uint32_t keyOf(uint32_t item) {
  return hash(item) % 1000;
}

enum class HeadsBy { Pixel, Hash };
enum class Push { Exchange, Compare, Sorted };
enum class Stage { Fragment, Compute, Vertex, Geometry, Layered };

// What is pushed, from where, into which lists.
struct Load {
  int width = 128;
  int height = 128;
  uint32_t layers = 8;
  int samples = 1;
  HeadsBy by = HeadsBy::Pixel;
  uint32_t hashedHeads = 64;
  uint32_t seed = 0;  // of the hash
  Push push = Push::Exchange;
  Stage stage = Stage::Fragment;
  bool headsInImage = false;
  std::optional<uint32_t> nodes = {};  // in the pool; none: as many as are needed

  uint32_t pixels() const { return static_cast<uint32_t>(width) * static_cast<uint32_t>(height); }
  uint32_t items() const { return pixels() * layers * static_cast<uint32_t>(samples); }
  uint32_t heads() const {
    return by == HeadsBy::Pixel ? pixels() * static_cast<uint32_t>(samples) : hashedHeads;
  }
  uint32_t headOf(uint32_t item) const { return (by == HeadsBy::Pixel ? item : hash(item + seed)) % heads(); }
  uint32_t capacity() const { return nodes.value_or(items()) + 1; }
};

struct Counters {
  uint32_t demand = 0;
  uint32_t gaveUp = 0;
  uint32_t retries = 0;
  uint32_t maxTries = 0;
};

// The buffers of shaders/lists/validation/list.glsl.
struct Pool {
  gl::Buffer links;
  gl::Buffer items;
  gl::Buffer outcome;
  gl::Texture headImage;

  Pool(const Context& context, const Load& load)
      // What is not in the pool stands behind it and is not to change.
      : links(zeroWords(context.device, load.heads() + load.items() + 1 + canaryWords)),
        items(zeroWords(context.device, load.items() + 1 + canaryWords)),
        outcome(zeroWords(context.device, sizeof(Counters) / 4)) {
    const std::vector<uint32_t> guard(load.items() + 1 + canaryWords - load.capacity(), canary);
    links.write(std::as_bytes(std::span(guard)), (load.heads() + load.capacity()) * sizeof(uint32_t));
    items.write(std::as_bytes(std::span(guard)), load.capacity() * sizeof(uint32_t));
    if (!load.headsInImage) return;
    const std::vector<uint32_t> zeros(load.heads());
    headImage = gl::Texture(context.device, "validation heads",
                            {.format = gl::Format::R32UI, .size = {static_cast<int>(load.heads()), 1, 1}},
                            std::as_bytes(std::span(zeros)));
  }

  void bind() const {
    links.bindStorage(0);
    items.bindStorage(1);
    outcome.bindStorage(2);
    if (headImage.name() != 0) headImage.bindImage(0);
  }
};

gl::ShaderDefines definesOf(const Load& load, bool plain) {
  constexpr const char* pushes[] = {"PUSH_EXCHANGE", "PUSH_COMPARE", "PUSH_SORTED"};
  gl::ShaderDefines defines = {
      {"WIDTH", fmt::format("{}u", load.width)},
      {"HEIGHT", fmt::format("{}u", load.height)},
      {"LAYERS", fmt::format("{}u", load.layers)},
      {"SAMPLES", fmt::format("{}", load.samples)},
      {"COUNT", fmt::format("{}u", load.items())},
      {"HEADS", fmt::format("{}u", load.heads())},
      {"CAPACITY", fmt::format("{}u", load.capacity())},
      {"HEAD_OF",
       load.by == HeadsBy::Pixel ? "(item % HEADS)" : fmt::format("(hash(item + {}u) % HEADS)", load.seed)},
      {pushes[static_cast<int>(load.push)], "1"}};
  if (plain) defines.emplace_back("PUSH_PLAIN", "1");
  if (load.headsInImage) defines.emplace_back("HEADS_IN_IMAGE", "1");
  return defines;
}

// Pushes all items of the load, without a barrier afterwards.
void pushAll(const Context& context, const Load& load, const gl::ShaderDefines& defines) {
  gl::Device& device = context.device;
  const auto draw = [&](std::vector<std::string> files, size_t vertices, size_t instances,
                        gl::Primitive primitive, int layers = 0) {
    const gl::Program& program = probeProgram(context, std::move(files), defines);
    const gl::Framebuffer nothing({load.width, load.height}, load.samples, layers);
    gl::setDrawState({.program = &program, .target = &nothing, .viewport = {0, 0, load.width, load.height}});
    gl::drawGenerated(device, vertices, instances, primitive);
  };
  using gl::Primitive;
  switch (load.stage) {
    case Stage::Fragment:
      return draw({"layers.vert", "list.frag"}, 3, load.layers, Primitive::Triangles);
    case Stage::Compute:
      return gl::dispatchLinear(probeProgram(context, {"list.comp"}, defines), load.items());
    case Stage::Vertex:
      return draw({"list.vert", "nothing.frag"}, load.items(), 1, Primitive::Points);
    case Stage::Geometry:
      return draw({"points.vert", "list.geom", "nothing.frag"}, load.items(), 1, Primitive::Points);
    case Stage::Layered:
      return draw({"layers.vert", "to_layer.geom", "list_layered.frag"}, 3, load.layers, Primitive::Triangles,
                  static_cast<int>(load.layers));
  }
}

// What a walk over all lists found.
struct Walk {
  uint64_t stored = 0;  // items reached
  uint64_t lost = 0;    // items that should be in a list and are not
  uint64_t twice = 0;   // items reached again, by another node
  uint64_t shared = 0;  // lists that run into a node that was reached before: a cycle, or two lists joined
  uint64_t stray = 0;   // nodes outside the pool, and items in a list that is not theirs
  uint64_t unsorted = 0;
  uint64_t canaries = 0;  // words behind the pool that were written
  uint64_t longest = 0;
  Counters counters;

  bool right() const {
    return lost + twice + shared + stray + unsorted + canaries == 0 && counters.gaveUp == 0;
  }
  std::string fault() const {
    std::string text;
    const auto add = [&](uint64_t count, const char* what) {
      if (count != 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, what);
    };
    add(lost, "items lost");
    add(twice, "items twice");
    add(shared, "lists joined or cyclic");
    add(stray, "items astray");
    add(unsorted, "pairs out of order");
    add(canaries, "words written past the pool");
    add(counters.gaveUp, "pushes gave up");
    return text;
  }
};

Walk walk(const Load& load, const Pool& pool) {
  const uint32_t heads = load.heads(), capacity = load.capacity();
  std::vector<uint32_t> links = pool.links.readValues<uint32_t>(heads + load.items() + 1 + canaryWords);
  const auto items = pool.items.readValues<uint32_t>(load.items() + 1 + canaryWords);
  if (load.headsInImage) pool.headImage.read(std::as_writable_bytes(std::span(links).first(heads)));
  Walk walk;
  walk.counters = pool.outcome.readValue<Counters>();
  std::vector<bool> reached(capacity), seen(load.items());
  for (uint32_t head = 0; head < heads; ++head) {
    uint64_t length = 0;
    uint32_t previous = 0;
    for (uint32_t node = links[head]; node != 0; node = links[heads + node]) {
      if (node >= capacity || items[node] >= load.items()) {
        ++walk.stray;
        break;
      }
      if (reached[node]) {
        ++walk.shared;
        break;
      }
      reached[node] = true;
      const uint32_t item = items[node];
      if (load.headOf(item) != head) ++walk.stray;
      if (seen[item]) ++walk.twice;
      seen[item] = true;
      if (load.push == Push::Sorted && previous != 0 &&
          std::pair(keyOf(items[previous]), items[previous]) >= std::pair(keyOf(item), item))
        ++walk.unsorted;
      previous = node;
      ++length;
    }
    walk.longest = std::max(walk.longest, length);
  }
  walk.stored = static_cast<uint64_t>(std::count(seen.begin(), seen.end(), true));
  const uint64_t expected = std::min<uint64_t>(load.items(), capacity - 1);
  walk.lost = expected - std::min(expected, walk.stored);
  const auto written = [](uint32_t word) { return word != canary; };
  walk.canaries =
      static_cast<uint64_t>(std::count_if(links.begin() + heads + capacity, links.end(), written) +
                            std::count_if(items.begin() + capacity, items.end(), written));
  return walk;
}

Walk build(const Context& context, const Load& load, bool plain = false) {
  const Pool pool(context, load);
  pool.bind();
  pushAll(context, load, definesOf(load, plain));
  gl::storageBarrier();
  if (load.headsInImage) gl::imageBarrier();
  return walk(load, pool);
}

Result failed(std::string finding, std::string meaning) {
  return {Verdict::Fail, std::move(finding), std::move(meaning), {}};
}

// Builds each load; then the control, the last one by plain loads and stores, must be seen failing.
Result checkLoads(const Context& context, std::vector<Load> loads, const std::string& meaning) {
  Result result;
  for (Load& load : loads) load.seed = static_cast<uint32_t>(context.seed);
  for (const Load& load : loads) {
    const Walk walk = build(context, load);
    result.figures.emplace_back(fmt::format("items in {} lists", load.heads()), int64_t{load.items()});
    result.figures.emplace_back("longest list", static_cast<int64_t>(walk.longest));
    if (load.push != Push::Exchange) {
      result.figures.emplace_back("retries", int64_t{walk.counters.retries});
      result.figures.emplace_back("most tries of one push", int64_t{walk.counters.maxTries});
    }
    if (walk.right()) continue;
    result.verdict = Verdict::Fail;
    result.finding = fmt::format("{} items in {} lists: {}", load.items(), load.heads(), walk.fault());
    result.meaning = meaning;
    return result;
  }
  const Walk control = build(context, loads.back(), true);
  result.figures.emplace_back("items lost without atomics", static_cast<int64_t>(control.lost));
  if (control.right()) {
    result.verdict = Verdict::NoPower;
    result.finding = "without atomics nothing was lost either";
  }
  return result;
}

uint32_t many(const Context& context) {
  return context.scale == Scale::Full ? 32 : 8;
}

Result listExchange(const Context& context) {
  return checkLoads(context, {{.layers = many(context)}, {.layers = many(context), .by = HeadsBy::Hash}},
                    "lists that are pushed to with an exchange lose nodes on this driver");
}

Result listOneHead(const Context& context) {
  return checkLoads(context, {{.layers = many(context), .by = HeadsBy::Hash, .hashedHeads = 1}},
                    "lists lose nodes where many fragments push to one");
}

Result listCompare(const Context& context) {
  return checkLoads(context,
                    {{.layers = many(context) / 2, .by = HeadsBy::Hash, .push = Push::Compare},
                     {.width = 64, .height = 64, .layers = many(context), .push = Push::Sorted},
                     {.width = 64,
                      .height = 64,
                      .layers = many(context),
                      .by = HeadsBy::Hash,
                      .hashedHeads = 1024,
                      .push = Push::Sorted}},
                    "lists that are built with compare-and-swap are wrong on this driver");
}

Result listImageHead(const Context& context) {
  return checkLoads(context, {{.layers = many(context), .by = HeadsBy::Hash, .headsInImage = true}},
                    "heads of lists must stand in a buffer, not in an image, on this driver");
}

Result listOverflow(const Context& context) {
  const std::string meaning = "a pool that is too small is not seen, or memory behind it is overwritten";
  Load load{.width = 64, .height = 64, .layers = many(context)};
  Result result;
  for (const uint32_t nodes : {load.items() / 2, 1u, 0u}) {
    load.nodes = nodes;
    const Walk walk = build(context, load);
    result.figures.emplace_back(fmt::format("demand with {} nodes", nodes), int64_t{walk.counters.demand});
    if (!walk.right()) return failed(fmt::format("a pool of {} nodes: {}", nodes, walk.fault()), meaning);
    if (walk.counters.demand != load.items())
      return failed(fmt::format("a pool of {} nodes: demand of {} counted as {}", nodes, load.items(),
                                walk.counters.demand),
                    meaning);
  }
  load.nodes = load.items() / 2;
  const Pool pool(context, load);
  pool.bind();
  gl::ShaderDefines defines = definesOf(load, false);
  defines.emplace_back("MUTANT_NO_BOUND", "1");
  pushAll(context, load, defines);
  gl::storageBarrier();
  const Walk control = walk(load, pool);
  result.figures.emplace_back("words written past the pool without the bound",
                              static_cast<int64_t>(control.canaries));
  if (control.canaries == 0) {
    result.verdict = Verdict::NoPower;
    result.finding = "without the bound nothing was written past the pool either";
  }
  return result;
}

// Frames that build, walk and clear the same lists, one after the other, without waiting for any.
struct Reuse {
  bool clear = true;
  bool barriers = true;
};

uint32_t wrongPixels(const Context& context, const Reuse& reuse) {
  const Load load{.width = 64, .height = 64, .layers = 8};
  const int frames = context.scale == Scale::Full ? 100 : 30;
  const gl::ShaderDefines defines = definesOf(load, false);
  Pool pool(context, load);
  gl::Buffer walks = zeroWords(context.device, 3);
  const gl::Program& read = probeProgram(context, {"traverse.comp"}, defines);
  for (int frame = 0; frame < frames; ++frame) {
    pool.outcome.clear();
    if (reuse.clear) pool.links.clear();
    pool.bind();
    walks.bindStorage(3);
    pushAll(context, load, defines);
    if (reuse.barriers) gl::storageBarrier();
    gl::dispatchLinear(read, load.heads());
    if (reuse.barriers) gl::storageBarrier();
  }
  gl::storageBarrier();
  const auto found = walks.readValues<uint32_t>(3);
  const uint32_t unwalked = static_cast<uint32_t>(frames) * load.heads() - found[1];
  return found[0] + unwalked;
}

Result listReuse(const Context& context) {
  const bool noBarrier = context.mutant == "NO_BARRIER";
  const uint32_t wrong =
      wrongPixels(context, {.clear = context.mutant != "NO_CLEAR", .barriers = !noBarrier});
  if (wrong != 0)
    return failed(fmt::format("{} pixels read wrong lists", wrong),
                  "a pass does not see the lists that the pass before it built");
  Result result;
  const uint32_t stale = wrongPixels(context, {.clear = false});
  const uint32_t unordered = wrongPixels(context, {.barriers = false});
  result.figures = {{"wrong pixels without the clear", int64_t{stale}},
                    {"wrong pixels without the barriers", int64_t{unordered}}};
  if (stale == 0 || noBarrier) {
    result.verdict = Verdict::NoPower;
    result.finding =
        noBarrier ? "without the barriers no pixel was wrong" : "without the clear no pixel was wrong either";
  }
  return result;
}

struct Torn {
  uint32_t demand = 0;
  uint32_t walked = 0;
  uint32_t torn = 0;
  uint32_t boundHits = 0;
};

Torn payloads(const Context& context, int quads, uint32_t count, bool atomic) {
  constexpr uint32_t heads = 256;
  gl::ShaderDefines defines = {{"QUADS", fmt::format("{}", quads)},
                               {"HEADS", fmt::format("{}u", heads)},
                               {"COUNT", fmt::format("{}u", count)}};
  if (!atomic) defines.emplace_back("WITHOUT_ATOMIC", "1");
  const gl::Buffer headWords = zeroWords(context.device, heads);
  const gl::Buffer nodes = zeroWords(context.device, (size_t{count} + 1) * static_cast<size_t>(quads) * 4);
  const gl::Buffer outcome = zeroWords(context.device, sizeof(Torn) / 4);
  headWords.bindStorage(0);
  nodes.bindStorage(1);
  outcome.bindStorage(2);
  gl::dispatchLinear(probeProgram(context, {"payload_write.comp"}, defines), count);
  gl::storageBarrier();
  gl::dispatchLinear(probeProgram(context, {"payload_read.comp"}, defines), heads);
  gl::storageBarrier();
  Torn torn = outcome.readValue<Torn>();
  // The layout as the CPU has it: the item and its list, at a stride of `quads` times 16 bytes.
  const auto words = nodes.readValues<uint32_t>((size_t{count} + 1) * static_cast<size_t>(quads) * 4);
  std::vector<bool> seen(count);
  for (uint32_t node = 1; node <= count; ++node) {
    const uint32_t item = words[size_t{node} * static_cast<size_t>(quads) * 4 + 1];
    if (item >= count || seen[item]) {
      ++torn.torn;
      continue;
    }
    seen[item] = true;
  }
  return torn;
}

Result listNodePayload(const Context& context) {
  const uint32_t count = context.scale == Scale::Full ? 65536 : 4096;
  Result result;
  for (const int quads : {1, 2, 3, 4}) {
    const Torn torn = payloads(context, quads, count, true);
    if (torn.torn != 0 || torn.walked != count || torn.boundHits != 0)
      return failed(fmt::format("nodes of {} bytes: {} of {} torn, {} reached", quads * 16, torn.torn, count,
                                torn.walked),
                    "nodes do not hold what was written into them before a barrier");
  }
  const Torn control = payloads(context, 4, count, false);
  result.figures = {{"nodes", int64_t{count}}, {"nodes torn when two share one", int64_t{control.torn}}};
  if (control.torn == 0) {
    result.verdict = Verdict::NoPower;
    result.finding = "nodes that are taken without atomics were not torn either";
  }
  return result;
}

// One stage, sampling or size of target that lists are built from.
struct Place {
  const char* name;
  Load load;
  bool present;  // whether this driver has it
};

std::vector<Place> places(const Context& context) {
  const gl::Limits& limits = context.device.limits();
  const int wide = std::min({limits.viewportSize, limits.framebufferSize, 16384});
  const Load small{.width = 64, .height = 64, .layers = 4};
  const auto at = [&](Stage stage) {
    Load load = small;
    load.stage = stage;
    return load;
  };
  Load shared = at(Stage::Compute);
  shared.by = HeadsBy::Hash;
  Load sampled = small;
  sampled.samples = 4;
  return {
      {"vertex", at(Stage::Vertex), limits.vertexStorageBlocks >= 3},
      {"geometry", at(Stage::Geometry), limits.geometryStorageBlocks >= 3},
      {"compute", at(Stage::Compute), true},
      {"compute, shared lists", shared, true},
      {"layered", at(Stage::Layered), limits.framebufferLayers >= 4},
      {"4 samples", sampled, limits.samples >= 4},
      {"1x1 viewport", {.width = 1, .height = 1, .layers = 16}, true},
      {"widest viewport", {.width = wide, .height = 4, .layers = 2}, true},
      {"highest viewport", {.width = 4, .height = wide, .layers = 2}, true},
  };
}

// The lists as fragments see them: pixels that do not hold each of their items once.
uint32_t wrongInFragments(const Context& context, const Load& load, const Pool& pool) {
  const gl::Buffer walks = zeroWords(context.device, 3);
  pool.bind();
  walks.bindStorage(3);
  const gl::Program& read = probeProgram(context, {"layers.vert", "traverse.frag"}, definesOf(load, false));
  const gl::Framebuffer nothing({load.width, load.height});
  gl::setDrawState({.program = &read, .target = &nothing, .viewport = {0, 0, load.width, load.height}});
  gl::drawGenerated(context.device, 3, 1);
  gl::storageBarrier();
  const auto found = walks.readValues<uint32_t>(3);
  return found[0] + load.pixels() - found[1];
}

Result listStages(const Context& context) {
  Result result;
  std::string faults;
  for (const Place& place : places(context)) {
    if (!place.present) {
      result.figures.emplace_back(place.name, "absent");
      continue;
    }
    const Pool pool(context, place.load);
    pool.bind();
    pushAll(context, place.load, definesOf(place.load, false));
    gl::storageBarrier();
    const Walk found = walk(place.load, pool);
    std::string fault = found.fault();
    if (place.load.samples == 1 && place.load.by == HeadsBy::Pixel)
      if (const uint32_t wrong = wrongInFragments(context, place.load, pool); wrong != 0)
        fault += fmt::format("{}{} pixels wrong as fragments read them", fault.empty() ? "" : ", ", wrong);
    result.figures.emplace_back(place.name, fault.empty() ? "right" : fault);
    if (!fault.empty()) faults += fmt::format("{}{}: {}", faults.empty() ? "" : "; ", place.name, fault);
  }
  if (!faults.empty()) {
    result.verdict = Verdict::Fail;
    result.finding = faults;
    result.meaning = "lists are to be built from whole fragments and compute shaders on this driver";
    return result;
  }
  return result;
}

// Whether the newest node of each list is the one that was drawn last, and so on down.
Result listOrder(const Context& context) {
  const Load load{.width = 64, .height = 64, .layers = 8};
  const Pool pool(context, load);
  pool.bind();
  pushAll(context, load, definesOf(load, false));
  gl::storageBarrier();
  const auto links = pool.links.readValues<uint32_t>(load.heads() + load.items() + 1);
  const auto items = pool.items.readValues<uint32_t>(load.items() + 1);
  int64_t ordered = 0;
  for (uint32_t head = 0; head < load.heads(); ++head) {
    uint32_t expected = load.layers;
    uint32_t node = links[head];
    for (uint32_t steps = 0; node != 0 && node <= load.items() && steps < load.layers; ++steps) {
      if (items[node] / load.heads() != --expected) break;
      node = links[load.heads() + node];
    }
    if (node == 0 && expected == 0) ++ordered;
  }
  Result result;
  result.figures = {{"pixels in the order of their draws", ordered}, {"pixels", int64_t{load.heads()}}};
  result.finding =
      fmt::format("{} of {} pixels hold their fragments in the order of the draws", ordered, load.heads());
  result.meaning = "no driver has to: sort by what is stored";
  return result;
}

}  // namespace

std::vector<Check> listsChecks() {
  const std::string group = "lists";
  const std::vector<std::string> all = {"spinlock", "lockfree", "append", "count"};
  return {
      {.name = "list-exchange",
       .group = group,
       .does = "pushes to the front by exchange, a list a pixel and shared ones: each item once",
       .strategies = {"spinlock", "append"},
       .mutants = {"NO_ATOMIC"},
       .run = listExchange},
      {.name = "list-one-head",
       .group = group,
       .does = "the same, all fragments into one list",
       .strategies = {"spinlock", "append"},
       .mutants = {"NO_ATOMIC"},
       .run = listOneHead},
      {.name = "list-cas",
       .group = group,
       .does = "pushes and sorted insertions by compare-and-swap: each item once, sorted",
       .strategies = {"lockfree"},
       .mutants = {"NO_ATOMIC"},
       .run = listCompare},
      {.name = "list-overflow",
       .group = group,
       .does = "pools too small: full, nothing behind them written, the demand exact",
       .strategies = {"spinlock", "lockfree", "append"},
       .mutants = {"NO_BOUND"},
       .run = listOverflow},
      {.name = "list-reuse",
       .group = group,
       .does = "frames that build, walk and clear the same lists without waiting",
       .strategies = all,
       .mutants = {"NO_CLEAR", "NO_BARRIER"},
       .run = listReuse},
      {.name = "list-image-head",
       .group = group,
       .does = "heads in an image, nodes in a buffer",
       .mutants = {"NO_ATOMIC"},
       .run = listImageHead},
      {.name = "list-node-payload",
       .group = group,
       .does = "nodes of 16 to 64 bytes with a checksum, read by another pass",
       .strategies = all,
       .mutants = {"NO_ATOMIC"},
       .run = listNodePayload},
      {.name = "list-stages",
       .group = group,
       .does = "lists from vertices, primitives, compute, samples, layers and odd viewports",
       .mutants = {"NO_ATOMIC"},
       .run = listStages},
      {.name = "list-order",
       .group = group,
       .does = "whether links follow the order of draws",
       .run = listOrder},
  };
}

}  // namespace sfumato::lists::validation
