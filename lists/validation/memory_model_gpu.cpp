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
  bool atomic = false;          // nothing but atomic operations
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
    {"RMW", {{add(Kind::Add, 0), add(Kind::Add, 1)}, {add(Kind::Add, 2), add(Kind::Add, 3)}}, true},
    {"plain RMW",
     {{add(Kind::PlainAdd, 0), add(Kind::PlainAdd, 1)}, {add(Kind::PlainAdd, 2), add(Kind::PlainAdd, 3)}}},
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

// What one test came to with a barrier between its operations, and without.
struct WithAndWithout {
  Counts with;
  Counts without;
};

constexpr uint32_t placeX(uint32_t instance, uint32_t seed, uint32_t instances) {
  return (instance * 40503u + seed) % instances;
}
constexpr uint32_t placeY(uint32_t instance, uint32_t seed, uint32_t instances) {
  return instances + (instance * 27191u + seed * 3u) % instances;
}

// Runs all tests, each in many instances, and adds to `counts`. `seed` varies places, delays and stress.
void run(const Context& context, const std::vector<Litmus>& tests, Stages stages, const char* qualifier,
         uint32_t seed, std::vector<WithAndWithout>& counts) {
  const Patches patches{.grid = stages == Stages::VertexFragment ? 1u : 2u, .patch = 16};
  const auto lanes = static_cast<uint32_t>(stages == Stages::VertexFragment ? patches.pixels() : 512);
  const auto instances = static_cast<uint32_t>(sized(context, 32768, 65536));
  const gl::Buffer memory = zeroWords(context.device, size_t{instances} * 2 + 4096);
  const gl::Buffer results = zeroWords(context.device, size_t{instances} * 4);
  const gl::Buffer meeting = zeroWords(context.device, 5 + lanes);
  std::vector<uint32_t> parameters = {seed, seed & 1u, static_cast<uint32_t>(tests.size())};
  for (const Litmus& test : tests) {
    for (size_t t = 0; t < 4; ++t)
      for (size_t i = 0; i < 2; ++i)
        parameters.push_back(t < test.threads.size() ? test.threads[t][i].packed() : 0);
    parameters.push_back(static_cast<uint32_t>(test.threads.size()));
  }
  const gl::Buffer described(context.device, "validation", std::span<const uint32_t>(parameters));
  memory.bindStorage(0);
  results.bindStorage(1);
  meeting.bindStorage(2);
  described.bindStorage(3);
  gl::ShaderDefines defines = patches.defines();
  defines.insert(defines.end(), {{"QUALIFIER", qualifier},
                                 {"LANES", std::to_string(lanes) + "u"},
                                 {"ROUNDS", std::to_string(instances / lanes) + "u"}});
  switch (stages) {
    case Stages::Compute:
      gl::dispatch(probeProgram(context, {"litmus.comp"}, defines), {2 * lanes / 64, 1, 1});
      break;
    case Stages::Fragment:
      drawPatches(context.device, probeProgram(context, {"layers.vert", "litmus.frag"}, defines), patches);
      break;
    case Stages::VertexFragment: {
      defines.emplace_back("VERTICES", "1");
      const gl::Program& fragments = probeProgram(context, {"layers.vert", "litmus.frag"}, defines);
      const gl::Program& vertices = probeProgram(context, {"litmus.vert", "nothing.frag"}, defines);
      drawPatches(context.device, fragments, patches);
      gl::flush();  // so that the fragments can be on their way while the vertices are
      const gl::Framebuffer nothing(glm::ivec2(64));
      gl::setDrawState({.program = &vertices, .target = &nothing, .viewport = {0, 0, 64, 64}});
      gl::drawGenerated(context.device, lanes, 1, gl::Primitive::Points);
      break;
    }
  }
  gl::storageBarrier();

  const auto words = memory.readValues<uint32_t>(size_t{instances} * 2);
  const auto told = results.readValues<uint32_t>(size_t{instances} * 4);
  for (uint32_t t = 0; t < tests.size(); ++t) {
    const Litmus& test = tests[t];
    std::set<Ending> possible;
    interleave(test, {}, {}, possible);
    const std::set<Ending> sequential = oneByOne(test);
    const auto own = static_cast<uint32_t>(lanes * 2 / test.threads.size());
    for (uint32_t round = t; round < instances / lanes; round += static_cast<uint32_t>(tests.size())) {
      const bool barrier = round / tests.size() % 2 == 0;
      Counts& these = barrier ? counts[t].with : counts[t].without;
      for (uint32_t i = round * lanes; i < round * lanes + own; ++i) {
        const Ending ending = {told[i * 4],
                               told[i * 4 + 1],
                               told[i * 4 + 2],
                               told[i * 4 + 3],
                               words[placeX(i, seed, instances)],
                               words[placeY(i, seed, instances)]};
        ++(sequential.count(ending) != 0 ? these.sequential
           : possible.count(ending) != 0 ? these.interleaved
                                         : these.forbidden);
      }
    }
  }
}

std::string told(const Counts& counts) {
  return fmt::format("{} in sequence, {} interleaved, {} forbidden", counts.sequential, counts.interleaved,
                     counts.forbidden);
}

// How a test is judged. What no order of operations explains is forbidden with a barrier between them; in
// coherence tests without one as well; in a control it shows that it could have been seen.
enum class Judged { WithBarrier, Always, Control };

// Runs all tests in all stages until each has been seen to interleave, or each control to fail.
Result litmus(const Context& context, const std::vector<Litmus>& tests, const std::vector<Judged>& judged,
              const std::string& meaning) {
  Result result;
  std::string unseen;
  auto seed = static_cast<uint32_t>(context.seed);
  const bool controlled = std::count(judged.begin(), judged.end(), Judged::Control) != 0;
  for (const Stages stages : allStages) {
    std::vector<WithAndWithout> counts(tests.size());
    std::string missing;
    untilSeen(context, 0.6, [&] {
      for (const char* qualifier : {"coherent", "volatile"})
        run(context, tests, stages, qualifier, ++seed, counts);
      missing.clear();
      for (size_t t = 0; t < tests.size(); ++t) {
        // Atomic operations of one word do not interleave: their control speaks for them.
        const Counts& told = counts[t].with;
        const bool seen = judged[t] == Judged::Control ? told.forbidden != 0
                          : tests[t].atomic            ? controlled
                                                       : told.interleaved + told.forbidden != 0;
        if (!seen) missing += (missing.empty() ? "" : ", ") + tests[t].name;
      }
      return missing.empty();
    });
    // The engine builds lists in compute and in fragment shaders.
    if (!missing.empty() && stages == Stages::VertexFragment)
      result.finding = "not shown where vertices meet fragments: " + missing;
    else if (!missing.empty())
      unseen += (unseen.empty() ? "" : "; ") + name(stages) + ": " + missing;
    for (size_t t = 0; t < tests.size(); ++t) {
      const std::string label = name(stages) + " " + tests[t].name;
      result.figures.emplace_back(label, told(counts[t].with));
      result.figures.emplace_back(label + ", no barrier", told(counts[t].without));
      if (judged[t] == Judged::Control || result.verdict == Verdict::Fail) continue;
      Counts bad = counts[t].with;
      if (judged[t] == Judged::Always) bad += counts[t].without;
      if (bad.forbidden == 0) continue;
      result.verdict = Verdict::Fail;
      result.finding = fmt::format("{}: {} of {} instances ended as no order of their operations explains",
                                   label, bad.forbidden, bad.all());
      result.meaning = meaning;
    }
  }
  if (result.verdict == Verdict::Pass && !unseen.empty()) {
    result.verdict = Verdict::NoPower;
    result.finding = "nothing forbidden was seen, but no operations in between either: " + unseen;
    result.meaning = "nothing, good or bad: these never ran closely enough side by side here";
  }
  return result;
}

Result litmusCoherence(const Context& context) {
  return litmus(
      context, coherenceTests,
      {Judged::Always, Judged::Always, Judged::Always, Judged::Always, Judged::Always, Judged::Control},
      "operations of one word have no order, or lose each other: no list can be trusted here");
}

Result litmusPublish(const Context& context) {
  return litmus(
      context, publishTests, std::vector(publishTests.size(), Judged::WithBarrier),
      "what was written before a flag, a barrier between, is not there for who has seen the flag: no list "
      "can be built and read in one pass");
}

Result litmusOrder(const Context& context) {
  return litmus(
      context, orderTests, std::vector(orderTests.size(), Judged::WithBarrier),
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
