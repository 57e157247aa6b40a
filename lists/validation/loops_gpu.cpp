// Checks of loops: values that leave them, how long they may be, and every way out of them.
#include <fmt/format.h>

#include <algorithm>

#include "base/hash.h"
#include "base/random.h"
#include "gl/commands.h"
#include "lists/validation/probe_gpu.h"

namespace sfumato::lists::validation {
namespace {

using base::hash;

enum class Stage { Fragment, Compute };
constexpr Stage stages[] = {Stage::Fragment, Stage::Compute};

const char* name(Stage stage) {
  return stage == Stage::Fragment ? "fragments" : "compute";
}

// What each of side x side invocations of shaders/lists/validation/FILE left in its word, given a table.
std::vector<uint32_t> invoke(const Context& context, const std::string& file, Stage stage, int side,
                             const std::vector<uint32_t>& table, gl::ShaderDefines defines) {
  const uint32_t count = static_cast<uint32_t>(side * side);
  defines.insert(defines.end(), {{"SIDE", fmt::format("{}u", side)},
                                 {"COUNT", fmt::format("{}u", count)},
                                 {"SEED", fmt::format("{}u", static_cast<uint32_t>(context.seed))}});
  const gl::Buffer in(context.device, "validation table", std::span(table));
  const gl::Buffer out = zeroWords(context.device, count);
  in.bindStorage(0);
  out.bindStorage(1);
  if (stage == Stage::Compute)
    gl::dispatchLinear(probeProgram(context, {file + ".comp"}, defines), count);
  else
    drawLayers(context.device, probeProgram(context, {"layers.vert", file + ".frag"}, defines), side, 1);
  gl::storageBarrier();
  return out.readValues<uint32_t>(count);
}

int64_t differing(const std::vector<uint32_t>& a, const std::vector<uint32_t>& b) {
  int64_t count = 0;
  for (size_t i = 0; i < a.size(); ++i) count += a[i] != b[i];
  return count;
}

// ---- values that leave a loop
// ------------------------------------------------------------------------------

constexpr uint32_t mostIterations = 64;

struct Form {
  int number;  // as in shaders/lists/validation/live_out.glsl
  const char* name;
};

uint32_t expectedLiveOut(int form, uint32_t id, uint32_t seed, const std::vector<uint32_t>& table) {
  const uint32_t n = 1 + hash(id + seed) % mostIterations;
  if (form == 3) {
    uint32_t value = id;
    for (uint32_t i = 0; i < n; ++i) value = value * 1664525u + 1013904223u;
    return value;
  }
  if (form == 5) {
    uint32_t previous = 0, current = 1;
    for (uint32_t i = 0; current != 0 && i < n; ++i) {
      previous = current;
      current = table[current];
    }
    return previous;
  }
  return table[n - 1];
}

// A list of 48 nodes in mixed order, which is also a table of different values.
std::vector<uint32_t> mixedList(uint64_t seed) {
  std::vector<uint32_t> order;
  for (uint32_t i = 2; i < mostIterations; ++i) order.push_back(i);
  base::Random random(seed);
  for (size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.next() % i]);
  std::vector<uint32_t> table(mostIterations);
  for (uint32_t i = 0; i < mostIterations; ++i) table[i] = 1000 + i;  // of nodes that are not in the list
  uint32_t node = 1;
  for (size_t i = 0; i < 47; ++i) node = table[node] = order[i];
  table[node] = 0;
  return table;
}

Result liveOut(const Context& context, const std::vector<Form>& forms, const char* meaning) {
  const int side = context.scale == Scale::Full ? 512 : 256;
  const std::vector<uint32_t> table = mixedList(context.seed);
  Result result;
  for (const Form& form : forms) {
    int64_t most = 0;
    for (const Stage stage : stages) {
      const auto found =
          invoke(context, "live_out", stage, side, table, {{"FORM", fmt::format("{}", form.number)}});
      std::vector<uint32_t> expected(found.size());
      for (uint32_t id = 0; id < expected.size(); ++id)
        expected[id] = expectedLiveOut(form.number, id, static_cast<uint32_t>(context.seed), table);
      const int64_t wrong = differing(found, expected);
      result.figures.emplace_back(fmt::format("{}, {}", form.name, name(stage)), wrong);
      most = std::max(most, wrong);
    }
    if (most == 0) continue;
    result.verdict = Verdict::Fail;
    result.finding += fmt::format("{}{} {}", result.finding.empty() ? "" : ", ", form.name, most);
    result.meaning = meaning;
  }
  if (result.verdict == Verdict::Fail)
    result.finding += fmt::format(" of {} lanes have another lane's value", side * side);
  return result;
}

Result liveOutAnyForm(const Context& context) {
  return liveOut(
      context, {{0, "loaded"}, {1, "copied"}, {2, "atomic"}, {3, "computed"}},
      "what a loop loads must be kept by a condition in a variable from before the loop; the engine "
      "does so");
}

Result liveOutSafeForms(const Context& context) {
  return liveOut(context, {{3, "computed"}, {4, "kept by a condition"}, {5, "walked"}},
                 "loops give wrong values in every form that the engine uses");
}

// ---- long loops
// ----------------------------------------------------------------------------------------------

struct LongLoop {
  const char* kind;  // the define; "" is a nest
  uint32_t outer;
  uint32_t inner;
};

// The fewest iterations that an invocation got.
uint32_t fewest(const Context& context, const LongLoop& loop, Stage stage, int side) {
  const uint32_t length = loop.outer * loop.inner;
  const bool walk = std::string_view(loop.kind) == "WALK";
  std::vector<uint32_t> links(walk ? length + 1 : 1);
  // From node to node in strides, so that nothing is guessed; the last one ends it.
  if (walk)
    for (uint32_t i = 1; i < length; ++i) links[i] = i + 1;
  gl::ShaderDefines defines = {{"OUTER", fmt::format("{}u", loop.outer)},
                               {"INNER", fmt::format("{}u", loop.inner)}};
  if (*loop.kind != '\0') defines.emplace_back(loop.kind, "1");
  const auto counts = invoke(context, "long_loop", stage, side, links, defines);
  return *std::min_element(counts.begin(), counts.end());
}

Result longLoops(const Context& context, const std::vector<LongLoop>& loops, const std::string& meaning) {
  Result result;
  for (const LongLoop& loop : loops)
    for (const Stage stage : stages) {
      const uint32_t asked = loop.outer * loop.inner;
      const uint32_t got = fewest(context, loop, stage, 4);
      const std::string what = fmt::format("{} of {}, {}",
                                           loop.kind == std::string_view("WALK")    ? "walk"
                                           : loop.kind == std::string_view("MARCH") ? "march"
                                                                                    : "nest",
                                           asked, name(stage));
      result.figures.emplace_back(what, int64_t{got});
      if (got == asked) continue;
      if (result.verdict == Verdict::Pass)
        result.finding = fmt::format("{}: ends after {} iterations, silently", what, got);
      result.verdict = Verdict::Fail;
      result.meaning = meaning;
    }
  return result;
}

Result loopLimit(const Context& context) {
  const uint32_t walk = context.scale == Scale::Full ? 1000000 : 200000;
  return longLoops(context, {{"WALK", walk, 1}, {"", 300, 300}, {"MARCH", 70000, 1}},
                   "longer walks and marches are cut on this driver; the engine splits them");
}

Result loopsOfTheEngine(const Context& context) {
  return longLoops(context, {{"WALK", 60000, 1}, {"", 240, 250}, {"MARCH", 60000, 1}},
                   "loops are cut that are as short as the engine splits them into");
}

// ---- ways out
// --------------------------------------------------------------------------------------------------

constexpr uint32_t leaveNodes = 1000;

uint32_t expectedSum(uint32_t id, uint32_t seed, const std::vector<uint32_t>& links) {
  uint32_t sum = id;
  uint32_t node = 1 + hash(id + seed) % leaveNodes;
  for (int step = 0; step < 64 && node != 0; ++step) {
    const uint32_t word = hash(node + id);
    node = links[node];
    if (word % 4 == 0) continue;
    for (uint32_t bit = 0; bit < 8; ++bit) {
      if ((word >> bit & 1) == 0) continue;
      if (bit > (word >> 8) % 8) break;
      sum += hash(word + bit);
      if (sum % 257 == 0) return sum;
    }
    sum = sum * 31 + word;
  }
  return ~sum;
}

Result breakContinue(const Context& context) {
  const int side = context.scale == Scale::Full ? 512 : 256;
  std::vector<uint32_t> links(leaveNodes + 1);
  base::Random random(context.seed);
  for (uint32_t i = 1; i < links.size(); ++i)
    links[i] = random.next() % 20 == 0 ? 0 : 1 + random.next() % leaveNodes;
  Result result;
  for (const Stage stage : stages) {
    const auto found =
        invoke(context, "leave_loop", stage, side, links, {{"NODES", fmt::format("{}u", leaveNodes)}});
    std::vector<uint32_t> expected(found.size());
    for (uint32_t id = 0; id < expected.size(); ++id)
      expected[id] = expectedSum(id, static_cast<uint32_t>(context.seed), links);
    const int64_t wrong = differing(found, expected);
    result.figures.emplace_back(fmt::format("wrong, {}", name(stage)), wrong);
    if (wrong == 0) continue;
    result.verdict = Verdict::Fail;
    result.finding += fmt::format("{}{} of {} invocations wrong in {}", result.finding.empty() ? "" : "; ",
                                  wrong, expected.size(), name(stage));
    result.meaning = "walks that leave early go astray on this driver";
  }
  return result;
}

}  // namespace

std::vector<Check> loopsChecks() {
  const std::vector<std::string> all = {"spinlock", "lockfree", "append", "count"};
  return {
      {.name = "live-out",
       .group = "loops",
       .does = "values that are made in a divergent loop and used after it, in any form",
       .run = liveOutAnyForm},
      {.name = "live-out-safe",
       .group = "loops",
       .does = "the same in the forms that the engine uses",
       .strategies = all,
       .mutants = {"NO_CONDITION"},
       .run = liveOutSafeForms},
      {.name = "loop-limit",
       .group = "loops",
       .does = "walks, nests and marches of 70,000 and more iterations",
       .mutants = {"CUT"},
       .run = loopLimit},
      {.name = "loop-engine",
       .group = "loops",
       .does = "the same of 60,000, more than the engine asks of one invocation",
       .strategies = all,
       .mutants = {"CUT"},
       .run = loopsOfTheEngine},
      {.name = "break-continue",
       .group = "loops",
       .does = "break, continue and return, nested, in a divergent walk",
       .strategies = all,
       .mutants = {"NO_CONTINUE"},
       .run = breakContinue},
  };
}

}  // namespace sfumato::lists::validation
