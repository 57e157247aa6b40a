// What one invocation sees of another's reads and writes: litmus tests, and the barriers of the API.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
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
    if (!missing.empty() && stages == Stages::VertexFragment) {
      if (result.verdict != Verdict::Fail)
        result.finding = "not shown where vertices meet fragments: " + missing;
    } else if (!missing.empty()) {
      unseen += (unseen.empty() ? "" : "; ") + name(stages) + ": " + missing;
    }
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

constexpr size_t apiWords = 64;  // a round: the alignment that every driver allows in bytes, as words
constexpr size_t apiRounds = 16;

using Words = std::vector<uint32_t>;

// One way in which the API reads what a shader wrote.
struct Use {
  std::string name;
  gl::Reader reader;
  std::function<Words(uint32_t round)> wanted;          // what the shader writes
  std::function<Words(const Words& wanted)> found;      // what is then found
  std::function<void(const gl::Buffer& written)> read;  // binding 2 is the place for what is found
};

Words padded(Words words) {
  words.resize(apiWords, 0);
  return words;
}

// What is left out of the rounds.
enum class Left { Nothing, Barrier, Write };

// Rounds in which something else was found than what had been written just before.
int64_t wrongRounds(const Context& context, const Use& use, Left out) {
  Words wanted;
  Words expected;
  for (uint32_t round = 0; round < apiRounds; ++round) {
    const Words words = padded(use.wanted(round));
    const Words found = padded(use.found(words));
    wanted.insert(wanted.end(), words.begin(), words.end());
    expected.insert(expected.end(), found.begin(), found.end());
  }
  const gl::Buffer source(context.device, "validation", std::span<const uint32_t>(wanted));
  const gl::Buffer written = zeroWords(context.device, apiWords);
  const gl::Buffer found = zeroWords(context.device, expected.size());
  const gl::Program& writer =
      probeProgram(context, {"api_write.comp"},
                   out == Left::Write ? gl::ShaderDefines{{"WITHOUT_WRITE", "1"}} : gl::ShaderDefines{});
  for (size_t round = 0; round < apiRounds; ++round) {
    const size_t offset = round * apiWords * sizeof(uint32_t);
    source.bindStorageRange(0, offset, apiWords * sizeof(uint32_t));
    found.bindStorageRange(2, offset, apiWords * sizeof(uint32_t));
    written.bindStorage(1);
    gl::dispatch(writer, {1, 1, 1});
    if (out != Left::Barrier) gl::barrierBefore(use.reader);
    use.read(written);
    gl::storageBarrier();
  }
  const auto told = found.readValues<uint32_t>(expected.size());
  int64_t wrong = 0;
  for (size_t round = 0; round < apiRounds; ++round)
    wrong += !std::equal(told.begin() + static_cast<long>(round * apiWords),
                         told.begin() + static_cast<long>((round + 1) * apiWords),
                         expected.begin() + static_cast<long>(round * apiWords));
  return wrong;
}

Result apiBarrier(const Context& context) {
  gl::Device& device = context.device;
  const gl::Framebuffer nothing(glm::ivec2(64));
  const auto prepareDraw = [&](const char* what) {
    gl::setDrawState({.program = &probeProgram(context, {"api_read.vert", "nothing.frag"}, {{what, "1"}}),
                      .target = &nothing,
                      .viewport = {0, 0, 64, 64}});
  };
  const auto compute = [&](const char* what) {
    gl::dispatch(probeProgram(context, {"api_read.comp"}, {{what, "1"}}), {1, 1, 1});
  };
  const auto counting = [](uint32_t round) {
    Words words(apiWords);
    for (uint32_t i = 0; i < apiWords; ++i) words[i] = round * 1000 + i + 1;
    return words;
  };
  const auto asTheyAre = [](const Words& words) { return words; };
  const gl::VertexAttribute value{.location = 0, .floats = 1, .offset = 0};
  Words inOrder(63);
  for (uint32_t i = 0; i < inOrder.size(); ++i) inOrder[i] = i;
  const gl::Buffer indices(device, "validation", std::span<const uint32_t>(inOrder));
  const gl::Buffer vertices = zeroWords(device, apiWords);
  gl::Texture texture(device, "validation", {.format = gl::Format::R32UI, .size = {apiWords, 1, 1}});
  gl::Buffer found = zeroWords(device, apiWords);

  std::vector<Use> uses = {
      {"storage block", gl::Reader::Storage, counting, asTheyAre,
       [&](const gl::Buffer&) { compute("READ_STORAGE"); }},
      {"uniform block", gl::Reader::Uniform, counting, asTheyAre,
       [&](const gl::Buffer& written) {
         written.bindUniform(0);
         compute("READ_UNIFORM");
       }},
      {"buffer texture", gl::Reader::TextureFetch, counting,
       [](Words words) {
         words.back() = 0;  // 21 texels of three
         return words;
       },
       [&](const gl::Buffer& written) {
         const gl::BufferTexture view(device, written, gl::BufferFormat::RGB32UI);
         view.bind(0);
         compute("READ_BUFFER_TEXTURE");
       }},
      {"pixel transfer", gl::Reader::PixelUnpack, counting, asTheyAre,
       [&](const gl::Buffer& written) {
         texture.copyFrom(written);
         texture.bind(0);
         compute("READ_TEXTURE");
       }},
      {"copy", gl::Reader::Update, counting, asTheyAre,
       [&](const gl::Buffer& written) {
         found.copyFrom(written, apiWords * sizeof(uint32_t));
         found.bindStorage(1);
         compute("READ_STORAGE");
       }},
      {"mapping", gl::Reader::Update, counting, asTheyAre,
       [&](const gl::Buffer& written) {
         written.withValues<uint32_t>(
             apiWords, [&](std::span<const uint32_t> words) { found.write(std::as_bytes(words)); });
         found.bindStorage(1);
         compute("READ_STORAGE");
       }},
      {"dispatch command", gl::Reader::IndirectCommand,
       [](uint32_t round) {
         return Words{round % 7 + 1, 1, 1};
       },
       [](const Words& words) { return Words{words[0]}; },
       [&](const gl::Buffer& written) {
         gl::dispatchIndirect(probeProgram(context, {"api_read.comp"}), written);
       }},
  };
  if (device.limits().vertexStorageBlocks > 0) {
    uses.push_back({"vertices", gl::Reader::VertexFetch,
                    [](uint32_t round) {
                      Words words(apiWords);
                      for (uint32_t i = 0; i < 63; ++i) {
                        const auto number = static_cast<float>(round * 1000 + i + 1);
                        std::memcpy(&words[i], &number, sizeof number);
                      }
                      return words;
                    },
                    [](const Words& words) {
                      Words numbers(63);
                      for (size_t i = 0; i < numbers.size(); ++i) {
                        float number = 0;
                        std::memcpy(&number, &words[i], sizeof number);
                        numbers[i] = static_cast<uint32_t>(number);
                      }
                      return numbers;
                    },
                    [&](const gl::Buffer& written) {
                      const gl::VertexArray array(device, written, 4, std::span(&value, 1), indices, 1, 1);
                      prepareDraw("READ_VERTICES");
                      gl::drawIndexed(array, {.indices = 63});
                    }});
    uses.push_back({"indices", gl::Reader::IndexFetch,
                    [](uint32_t round) {
                      return Words{round % 60, round % 60 + 1, round % 60 + 2};
                    },
                    [](const Words& words) {
                      Words met(apiWords, 0);
                      for (size_t i = 0; i < 3; ++i) met[words[i]] = 1;
                      return met;
                    },
                    [&](const gl::Buffer& written) {
                      const gl::VertexArray array(device, vertices, 4, std::span(&value, 1), written, 1, 1);
                      prepareDraw("READ_INDICES");
                      gl::drawIndexed(array, {.indices = 3});
                    }});
    uses.push_back({"draw command", gl::Reader::IndirectCommand,
                    [](uint32_t round) {
                      return Words{3, round % 7 + 1, 0, 0};
                    },
                    [](const Words& words) { return Words{words[1]}; },
                    [&](const gl::Buffer& written) {
                      prepareDraw("READ_INSTANCES");
                      gl::drawIndirect(device, written);
                    }});
  }

  Result result;
  std::string bad;
  std::string blind;
  int64_t without = 0;
  for (const Use& use : uses) {
    const int64_t wrong = wrongRounds(context, use, Left::Nothing);
    const int64_t loose = wrongRounds(context, use, Left::Barrier);
    without += loose;
    if (wrong != 0) bad += (bad.empty() ? "" : ", ") + use.name;
    if (wrongRounds(context, use, Left::Write) == 0) blind += (blind.empty() ? "" : ", ") + use.name;
    result.figures.emplace_back(use.name + ": wrong rounds", wrong);
    result.figures.emplace_back(use.name + ": wrong rounds without barrier", loose);
  }
  if (!bad.empty()) {
    result.verdict = Verdict::Fail;
    result.finding = "other words than were written, after the barrier, as: " + bad;
    result.meaning = "what a shader wrote cannot be read in these ways on this driver";
  } else if (!blind.empty()) {
    result.verdict = Verdict::NoPower;
    result.finding = "nothing was missed where nothing was written: " + blind;
    result.meaning = "nothing, good or bad";
  } else if (without == 0) {
    result.finding =
        fmt::format("new words were read in all {} ways without the barriers as well", uses.size());
    result.meaning = "that the barriers are needed cannot be shown here: keep them for other drivers";
  }
  return result;
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
      {"api-barrier",
       "memory-model",
       "what a shader wrote to a buffer is there for ten other ways of reading it after their barrier",
       all,
       {"NO_WRITE"},
       apiBarrier},
  };
}

}  // namespace sfumato::lists::validation
