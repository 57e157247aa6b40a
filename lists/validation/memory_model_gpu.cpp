// What one invocation sees of another's reads and writes: litmus tests, and the barriers of the API.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "gl/commands.h"
#include "gl/texture.h"
#include "lists/validation/probe_gpu.h"

namespace sfumato::lists::validation {
namespace {

// As the shader knows them (shaders/lists/validation/litmus.glsl).
enum class Kind : uint32_t { None, Load, Store, Add, PlainAdd };

struct Operation {
  Kind kind = Kind::None;
  uint32_t location = 0;  // 0: x, 1: y
  uint32_t value = 0;     // stored or added
  uint32_t slot = 0;      // where a result goes

  uint32_t packed() const { return static_cast<uint32_t>(kind) | location << 3 | value << 4 | slot << 8; }
};

using Thread = std::array<Operation, 2>;

struct Litmus {
  std::string name;
  std::vector<Thread> threads;  // 2 or 4
};

Operation load(uint32_t location, uint32_t slot) {
  return {Kind::Load, location, 0, slot};
}
Operation store(uint32_t location, uint32_t value) {
  return {Kind::Store, location, value, 0};
}
Operation add(Kind kind, uint32_t slot) {
  return {kind, 0, 1, slot};
}

constexpr uint32_t x = 0;
constexpr uint32_t y = 1;

// Reads and writes of one word keep one order.
const std::vector<Litmus> coherenceTests = {
    {"CoRR", {{store(x, 1), {}}, {load(x, 0), load(x, 1)}}},
    {"CoRW", {{load(x, 0), store(x, 1)}, {store(x, 2), {}}}},
    {"CoWR", {{store(x, 1), load(x, 0)}, {store(x, 2), {}}}},
    {"CoWW", {{store(x, 1), store(x, 2)}, {load(x, 0), load(x, 1)}}},
};
// What was written before a flag is there for whoever has seen the flag.
const std::vector<Litmus> publishTests = {
    {"MP", {{store(x, 1), store(y, 1)}, {load(y, 0), load(x, 1)}}},
    {"LB", {{load(x, 0), store(y, 1)}, {load(y, 1), store(x, 1)}}},
    {"S", {{store(x, 2), store(y, 1)}, {load(y, 0), store(x, 1)}}},
};
// A write is there for everybody before its thread goes on.
const std::vector<Litmus> orderTests = {
    {"SB", {{store(x, 1), load(y, 0)}, {store(y, 1), load(x, 1)}}},
    {"R", {{store(x, 1), store(y, 1)}, {store(y, 2), load(x, 0)}}},
    {"2+2W", {{store(x, 1), store(y, 2)}, {store(y, 1), store(x, 2)}}},
    {"IRIW", {{store(x, 1), {}}, {store(y, 1), {}}, {load(x, 0), load(y, 1)}, {load(y, 2), load(x, 3)}}},
};

// Results and the words' last values.
using Ending = std::array<uint32_t, 6>;

Ending step(Ending state, const Operation& operation) {
  uint32_t& word = state[4 + operation.location];
  if (operation.kind != Kind::None && operation.kind != Kind::Store) state[operation.slot] = word;
  if (operation.kind == Kind::Store) word = operation.value;
  if (operation.kind == Kind::Add || operation.kind == Kind::PlainAdd) word += operation.value;
  return state;
}

// All endings that there are when operations are done one after the other, in some order that keeps each
// thread's.
void interleave(const Litmus& test, std::array<size_t, 4> done, const Ending& state,
                std::set<Ending>& endings) {
  bool over = true;
  for (size_t t = 0; t < test.threads.size(); ++t) {
    if (done[t] == 2) continue;
    over = false;
    std::array<size_t, 4> next = done;
    ++next[t];
    interleave(test, next, step(state, test.threads[t][done[t]]), endings);
  }
  if (over) endings.insert(state);
}

// Those when each thread runs from its start to its end before another starts.
std::set<Ending> oneByOne(const Litmus& test) {
  std::vector<size_t> order(test.threads.size());
  for (size_t t = 0; t < order.size(); ++t) order[t] = t;
  std::set<Ending> endings;
  do {
    Ending state{};
    for (const size_t t : order)
      for (const Operation& operation : test.threads[t]) state = step(state, operation);
    endings.insert(state);
  } while (std::next_permutation(order.begin(), order.end()));
  return endings;
}

struct Counts {
  int64_t sequential = 0;   // as if one thread had run after the other
  int64_t interleaved = 0;  // possible only where they run at the same time
  int64_t forbidden = 0;    // in no order of the operations

  Counts& operator+=(const Counts& other) {
    sequential += other.sequential;
    interleaved += other.interleaved;
    forbidden += other.forbidden;
    return *this;
  }
  int64_t all() const { return sequential + interleaved + forbidden; }
};

enum class Stages { Compute, Fragment, VertexFragment };
constexpr Stages allStages[] = {Stages::Compute, Stages::Fragment, Stages::VertexFragment};

std::string name(Stages stages) {
  return stages == Stages::Compute ? "CS-CS" : stages == Stages::Fragment ? "FS-FS" : "VS-FS";
}

struct Variant {
  Stages stages = Stages::Compute;
  std::string qualifier = "coherent";
  bool barrier = true;
};

constexpr size_t instances = 32768;

gl::ShaderDefines defines(const Variant& variant, size_t lanes, const Patches& patches) {
  gl::ShaderDefines all = patches.defines();
  all.insert(all.end(), {{"QUALIFIER", variant.qualifier},
                         {"INSTANCES", std::to_string(instances) + "u"},
                         {"LANES", std::to_string(lanes) + "u"},
                         {"ROUNDS", std::to_string(instances / lanes) + "u"}});
  if (variant.barrier) all.emplace_back("WITH_BARRIER", "1");
  return all;
}

// Runs the test once in all instances. `seed` varies places, delays and stress.
Counts run(const Context& context, const Litmus& test, const Variant& variant, uint32_t seed) {
  constexpr size_t lanes = 512;
  const size_t perInstance = test.threads.size() / 2;
  const gl::Buffer memory = zeroWords(context.device, instances * 2 + 4096);
  const gl::Buffer results = zeroWords(context.device, instances * 4);
  const gl::Buffer meeting = zeroWords(context.device, 4 + lanes);
  std::array<uint32_t, 11> parameters{};
  for (size_t t = 0; t < test.threads.size(); ++t)
    for (size_t i = 0; i < 2; ++i) parameters[t * 2 + i] = test.threads[t][i].packed();
  parameters[8] = seed;
  parameters[9] = seed & 1u;
  parameters[10] = static_cast<uint32_t>(test.threads.size());
  const gl::Buffer described(context.device, "validation", std::span<const uint32_t>(parameters));
  memory.bindStorage(0);
  results.bindStorage(1);
  meeting.bindStorage(2);
  described.bindStorage(3);
  switch (variant.stages) {
    case Stages::Compute: {
      const gl::Program& program = probeProgram(context, {"litmus.comp"}, defines(variant, lanes, {}));
      gl::dispatch(program, {2 * lanes / 64, 1, 1});
      break;
    }
    case Stages::Fragment: {
      const Patches patches{.patch = 16};
      const gl::Program& program =
          probeProgram(context, {"layers.vert", "litmus.frag"}, defines(variant, lanes, patches));
      drawPatches(context.device, program, patches);
      break;
    }
    case Stages::VertexFragment: {
      const Patches patches{.grid = 1, .patch = 16};
      gl::ShaderDefines these = defines(variant, patches.pixels(), patches);
      these.emplace_back("VERTICES", "1");
      const gl::Program& fragments = probeProgram(context, {"layers.vert", "litmus.frag"}, these);
      const gl::Program& vertices = probeProgram(context, {"litmus.vert", "nothing.frag"}, these);
      drawPatches(context.device, fragments, patches);
      gl::flush();  // so that the fragments can be on their way while the vertices are
      const gl::Framebuffer nothing(glm::ivec2(64));
      gl::setDrawState({.program = &vertices, .target = &nothing, .viewport = {0, 0, 64, 64}});
      gl::drawGenerated(context.device, patches.pixels(), 1, gl::Primitive::Points);
      break;
    }
  }
  gl::storageBarrier();

  std::set<Ending> possible;
  interleave(test, {}, {}, possible);
  const std::set<Ending> sequential = oneByOne(test);
  const auto words = memory.readValues<uint32_t>(instances * 2);
  const auto told = results.readValues<uint32_t>(instances * 4);
  std::map<Ending, int64_t> seen;
  for (uint32_t i = 0; i < instances / perInstance; ++i)
    ++seen[{told[i * 4], told[i * 4 + 1], told[i * 4 + 2], told[i * 4 + 3],
            words[(i * 40503u + seed) % instances], words[instances + (i * 27191u + seed * 3u) % instances]}];
  Counts counts;
  for (const auto& [ending, times] : seen)
    (sequential.count(ending) != 0 ? counts.sequential
     : possible.count(ending) != 0 ? counts.interleaved
                                   : counts.forbidden) += times;
  return counts;
}

std::string told(const Counts& counts) {
  return fmt::format("{} in sequence, {} interleaved, {} forbidden", counts.sequential, counts.interleaved,
                     counts.forbidden);
}

// Runs all the tests in all stages, with barriers and (for the figures) without, until each was seen
// interleaved. `always`: what no order explains is forbidden without barriers as well.
Result litmus(const Context& context, const std::vector<Litmus>& tests, bool always,
              const std::string& meaning) {
  Result result;
  std::string unseen;
  auto seed = static_cast<uint32_t>(context.seed);
  for (const Stages stages : allStages) {
    std::map<std::string, Counts> with;
    std::map<std::string, Counts> without;
    std::string missing;
    untilSeen(context, [&] {
      missing.clear();
      for (const Litmus& test : tests) {
        Counts& counts = with[test.name];
        if (counts.forbidden != 0) continue;
        if (counts.interleaved != 0 && context.scale == Scale::Small) continue;
        for (const char* qualifier : {"coherent", "volatile"}) {
          counts += run(context, test, {stages, qualifier, true}, ++seed);
          without[test.name] += run(context, test, {stages, qualifier, false}, ++seed);
        }
        if (counts.interleaved == 0 && counts.forbidden == 0)
          missing += (missing.empty() ? "" : ", ") + test.name;
      }
      return missing.empty() && context.scale == Scale::Small;
    });
    if (!missing.empty()) unseen += (unseen.empty() ? "" : "; ") + name(stages) + ": " + missing;
    for (const Litmus& test : tests) {
      const std::string label = name(stages) + " " + test.name;
      const Counts& counts = with[test.name];
      const Counts& loose = without[test.name];
      result.figures.emplace_back(label, told(counts));
      result.figures.emplace_back(label + ", no barrier", told(loose));
      const bool looseFails = always && loose.forbidden != 0;
      if (result.verdict != Verdict::Pass || (counts.forbidden == 0 && !looseFails)) continue;
      const Counts& worse = counts.forbidden != 0 ? counts : loose;
      result.verdict = Verdict::Fail;
      result.finding =
          fmt::format("{}: {} of {} instances ended as no order of their operations explains{}", label,
                      worse.forbidden, worse.all(), counts.forbidden != 0 ? "" : " (no barrier)");
      result.meaning = meaning;
    }
  }
  if (result.verdict == Verdict::Pass && !unseen.empty()) {
    result.verdict = Verdict::NoPower;
    result.finding = fmt::format("nothing forbidden was seen, but nothing interleaved either in {}", unseen);
    result.meaning = "nothing, good or bad: these never ran closely enough side by side here";
  }
  return result;
}

Result litmusCoherence(const Context& context) {
  Result result =
      litmus(context, coherenceTests, true, "reads of one word go backwards: no list can be trusted here");
  // Additions of both threads to one word: none is lost. Where plain ones are lost, that could have been
  // seen.
  const Litmus atomic{"RMW",
                      {{add(Kind::Add, 0), add(Kind::Add, 1)}, {add(Kind::Add, 2), add(Kind::Add, 3)}}};
  Litmus plain = atomic;
  for (Thread& thread : plain.threads)
    for (Operation& operation : thread) operation.kind = Kind::PlainAdd;
  auto seed = static_cast<uint32_t>(context.seed);
  std::string powerless;
  for (const Stages stages : allStages) {
    Counts counts;
    Counts control;
    const bool seen = untilSeen(context, [&] {
      counts += run(context, atomic, {stages, "coherent", false}, ++seed);
      control += run(context, plain, {stages, "coherent", false}, ++seed);
      return control.forbidden != 0 || counts.forbidden != 0;
    });
    if (!seen) powerless += (powerless.empty() ? "" : ", ") + name(stages);
    result.figures.emplace_back(name(stages) + " RMW", told(counts));
    result.figures.emplace_back(name(stages) + " RMW, plain", told(control));
    if (result.verdict != Verdict::Fail && counts.forbidden != 0) {
      result.verdict = Verdict::Fail;
      result.finding = fmt::format("{} RMW: additions were lost in {} of {} instances", name(stages),
                                   counts.forbidden, counts.all());
      result.meaning = "atomic operations are not atomic: no list can be trusted here";
    }
  }
  if (result.verdict == Verdict::Pass && !powerless.empty()) {
    result.verdict = Verdict::NoPower;
    result.finding = "plain additions were not lost either in " + powerless;
    result.meaning = "nothing, good or bad: these never ran closely enough side by side here";
  }
  return result;
}

Result litmusPublish(const Context& context) {
  return litmus(
      context, publishTests, false,
      "what was written before a flag, a barrier between, is not there for who has seen the flag: no list "
      "can be built and read in one pass");
}

Result litmusOrder(const Context& context) {
  return litmus(
      context, orderTests, false,
      "a barrier does not hold a thread until its writes are seen: who needs that (Dekker's lock, say) "
      "uses atomics; the engine does");
}

}  // namespace

std::vector<Check> memoryModelChecks() {
  const std::vector<std::string> all = {"spinlock", "lockfree", "append", "count"};
  return {
      {"litmus-coherence",
       "memory-model",
       "CoRR, CoRW, CoWR, CoWW and atomic additions: one word has one order",
       all,
       {"SWAPPED", "PLAIN_ADD"},
       litmusCoherence},
      {"litmus-publish",
       "memory-model",
       "MP, LB, S: what stands before a barrier comes before what stands after it",
       {"spinlock", "lockfree"},
       {"SWAPPED"},
       litmusPublish},
      {"litmus-order",
       "memory-model",
       "SB, R, 2+2W, IRIW: a barrier waits until all see what was written: for information",
       {},
       {"SWAPPED"},
       litmusOrder},
  };
}

}  // namespace sfumato::lists::validation
