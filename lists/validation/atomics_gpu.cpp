// Checks of atomic operations, one at a time and under contention.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <set>

#include "base/hash.h"
#include "gl/commands.h"
#include "gl/texture.h"
#include "lists/validation/probe_gpu.h"

namespace sfumato::lists::validation {
namespace {

using base::hash;

enum class Stage { Fragment, Compute, Vertex, Geometry };

const char* stageName(Stage stage) {
  constexpr const char* names[] = {"fragment", "compute", "vertex", "geometry"};
  return names[static_cast<int>(stage)];
}

std::string constant(uint64_t value) {
  return fmt::format("{}u", value);
}

// Runs shaders/lists/validation/FILE in a stage: side x side fragments, or as many points or invocations.
void invoke(const Context& context, const std::string& file, Stage stage, int side,
            gl::ShaderDefines defines) {
  const auto count = static_cast<size_t>(side) * static_cast<size_t>(side);
  defines.insert(defines.end(), {{"SIDE", constant(static_cast<uint64_t>(side))},
                                 {"COUNT", constant(count)},
                                 {"SEED", constant(static_cast<uint32_t>(context.seed))}});
  const auto drawPoints = [&](std::vector<std::string> files) {
    const gl::Program& program = probeProgram(context, std::move(files), defines);
    const gl::Framebuffer nothing({1, 1});
    gl::setDrawState({.program = &program, .target = &nothing, .viewport = {0, 0, 1, 1}});
    gl::drawGenerated(context.device, count, 1, gl::Primitive::Points);
  };
  switch (stage) {
    case Stage::Fragment:
      return drawLayers(context.device, probeProgram(context, {"layers.vert", file + ".frag"}, defines), side,
                        1);
    case Stage::Compute:
      return gl::dispatchLinear(probeProgram(context, {file + ".comp"}, defines), count);
    case Stage::Vertex:
      return drawPoints({file + ".vert", "nothing.frag"});
    case Stage::Geometry:
      return drawPoints({"points.vert", file + ".geom", "nothing.frag"});
  }
}

Result failed(std::string finding, std::string meaning, std::vector<Figure> figures = {}) {
  return {Verdict::Fail, std::move(finding), std::move(meaning), std::move(figures)};
}

Result noPower(std::string finding, std::vector<Figure> figures) {
  return {Verdict::NoPower, std::move(finding), {}, std::move(figures)};
}

// ---- every operation
// ---------------------------------------------------------------------------------------

enum class Where { Buffer, Shared, Image, Counter };
constexpr uint32_t invocations = 64;
constexpr uint32_t operations = 8;
constexpr uint32_t stride = invocations + 1;  // slots of one operation: one each, and one for all
constexpr uint32_t slots = stride * operations;
constexpr const char* operationNames[] = {"add", "min", "max", "and", "or", "xor", "exchange", "compare"};

struct OperationRun {
  Where where;
  Stage stage;
  bool isSigned;

  std::string name() const {
    constexpr const char* places[] = {"buffer", "shared", "image", "counter"};
    return fmt::format("{} {}, {}", isSigned ? "int" : "uint", places[static_cast<int>(where)],
                       stageName(stage));
  }
};

uint32_t applied(uint32_t operation, uint32_t word, uint32_t value, uint32_t expected, bool isSigned) {
  const auto less = [&](uint32_t a, uint32_t b) {
    return isSigned ? static_cast<int32_t>(a) < static_cast<int32_t>(b) : a < b;
  };
  switch (operation) {
    case 0:
      return word + value;
    case 1:
      return less(value, word) ? value : word;
    case 2:
      return less(word, value) ? value : word;
    case 3:
      return word & value;
    case 4:
      return word | value;
    case 5:
      return word ^ value;
    case 6:
      return value;
    default:
      return word == expected ? value : word;
  }
}

struct OperationOutcome {
  std::vector<uint32_t> words;
  std::vector<uint32_t> returned;  // of the own slots, then of the common ones
};

// What is wrong with one operation; empty when nothing is.
std::string faultOf(uint32_t operation, const OperationOutcome& outcome, bool isSigned, uint32_t seed) {
  uint32_t wrongWords = 0, wrongReturns = 0;
  const uint32_t base = operation * stride, common = base + invocations;
  const auto valueOf = [&](uint32_t id) { return hash(slots + base + id + seed); };
  uint32_t folded = hash(common + seed);
  std::multiset<uint32_t> given = {folded}, got = {outcome.words[common]};
  uint32_t winners = 0, winner = 0;
  for (uint32_t id = 0; id < invocations; ++id) {
    const uint32_t slot = base + id, before = hash(slot + seed);
    wrongReturns += outcome.returned[slot] != before;
    wrongWords += outcome.words[slot] != applied(operation, before, valueOf(id), before + id % 2, isSigned);
    folded = applied(operation, folded, valueOf(id), 0, isSigned);
    given.insert(valueOf(id));
    const uint32_t returned = outcome.returned[slots + slot];
    got.insert(returned);
    if (returned == hash(common + seed)) {
      ++winners;
      winner = valueOf(id);
    }
  }
  bool commonRight = outcome.words[common] == folded;
  if (operation == 6) commonRight = given == got;  // exchanged values are neither made nor lost
  if (operation == 7) commonRight = winners == 1 && outcome.words[common] == winner;
  std::string fault;
  if (wrongReturns != 0) fault += fmt::format("{} wrong returns", wrongReturns);
  if (wrongWords != 0) fault += fmt::format("{}{} wrong words", fault.empty() ? "" : ", ", wrongWords);
  if (!commonRight) fault += fmt::format("{}the common word wrong", fault.empty() ? "" : ", ");
  return fault.empty() ? fault : fmt::format("{}: {}", operationNames[operation], fault);
}

std::string counterFault(const std::vector<uint32_t>& returned, const std::vector<uint32_t>& counters) {
  std::set<uint32_t> ups(returned.begin(), returned.begin() + invocations);
  std::set<uint32_t> downs(returned.begin() + invocations, returned.begin() + 2 * invocations);
  const auto counts = [](const std::set<uint32_t>& values) {
    return values.size() == invocations && *values.begin() == 0 && *values.rbegin() == invocations - 1;
  };
  if (counters != std::vector<uint32_t>{invocations, 0}) return "counters wrong";
  return counts(ups) && counts(downs) ? "" : "wrong returns";
}

std::string runOperations(const Context& context, const OperationRun& run) {
  const auto seed = static_cast<uint32_t>(context.seed);
  std::vector<uint32_t> initial(slots);
  for (uint32_t slot = 0; slot < slots; ++slot) initial[slot] = hash(slot + seed);
  gl::ShaderDefines defines = {{"TYPE", run.isSigned ? "int" : "uint"}};
  constexpr const char* wheres[] = {"IN_BUFFER", "IN_SHARED", "IN_IMAGE", "IN_COUNTER"};
  defines.emplace_back(wheres[static_cast<int>(run.where)], "1");
  defines.emplace_back("IMAGE", run.isSigned ? "iimage2D" : "uimage2D");
  defines.emplace_back("LAYOUT", run.isSigned ? "r32i" : "r32ui");

  gl::Device& device = context.device;
  const gl::Buffer words(device, "validation words", std::span<const uint32_t>(initial));
  const gl::Buffer returned = zeroWords(device, 2 * slots);
  const std::vector<uint32_t> counted = {0, invocations};
  const gl::Buffer counters(device, "validation counters", std::span<const uint32_t>(counted));
  gl::Texture image;
  if (run.where == Where::Image) {
    image = gl::Texture(device, "validation image",
                        {.format = run.isSigned ? gl::Format::R32I : gl::Format::R32UI,
                         .size = {static_cast<int>(slots), 1, 1}},
                        std::as_bytes(std::span(initial)));
    image.bindImage(0);
  }
  words.bindStorage(0);
  returned.bindStorage(1);
  counters.bindAtomicCounter(0);
  if (run.stage == Stage::Compute) {
    defines.emplace_back("SEED", constant(seed));
    gl::dispatch(probeProgram(context, {"ops.comp"}, defines), {1, 1, 1});
  } else {
    constexpr int side = 8;
    invoke(context, "ops", run.stage, side, defines);
  }
  gl::storageBarrier();
  gl::imageBarrier();

  OperationOutcome outcome{words.readValues<uint32_t>(slots), returned.readValues<uint32_t>(2 * slots)};
  if (run.where == Where::Image) image.read(std::as_writable_bytes(std::span(outcome.words)));
  if (run.where == Where::Counter) return counterFault(outcome.returned, counters.readValues<uint32_t>(2));
  std::string faults;
  for (uint32_t operation = 0; operation < operations; ++operation)
    if (const std::string fault = faultOf(operation, outcome, run.isSigned, seed); !fault.empty())
      faults += (faults.empty() ? "" : "; ") + fault;
  return faults;
}

bool present(const OperationRun& run, const gl::Limits& limits) {
  if (run.where == Where::Shared) return run.stage == Stage::Compute;
  if (run.stage == Stage::Vertex)
    return limits.vertexStorageBlocks >= 2 && (run.where != Where::Image || limits.vertexImages >= 1) &&
           (run.where != Where::Counter || limits.vertexCounters >= 2);
  if (run.stage == Stage::Geometry)
    return limits.geometryStorageBlocks >= 2 && (run.where != Where::Image || limits.geometryImages >= 1) &&
           (run.where != Where::Counter || limits.geometryCounters >= 2);
  return true;
}

Result runAll(const Context& context, const std::vector<OperationRun>& runs, const char* meaning) {
  Result result;
  for (const OperationRun& run : runs) {
    if (run.where == Where::Shared && run.stage != Stage::Compute) continue;
    if (run.where == Where::Counter && run.isSigned) continue;
    if (!present(run, context.device.limits())) {
      result.figures.emplace_back(run.name(), "absent");
      continue;
    }
    const std::string fault = runOperations(context, run);
    result.figures.emplace_back(run.name(), fault.empty() ? "right" : fault);
    if (fault.empty()) continue;
    if (result.verdict == Verdict::Pass) result.finding = fmt::format("{}: {}", run.name(), fault);
    result.verdict = Verdict::Fail;
    result.meaning = meaning;
  }
  return result;
}

constexpr Stage enginesStages[] = {Stage::Fragment, Stage::Compute};

Result operationsOfTheEngine(const Context& context) {
  std::vector<OperationRun> runs;
  for (const Stage stage : enginesStages)
    for (const bool isSigned : {false, true}) runs.push_back({Where::Buffer, stage, isSigned});
  return runAll(context, runs, "no list can be built on this driver");
}

Result operationsElsewhere(const Context& context) {
  std::vector<OperationRun> runs;
  for (const Where where : {Where::Buffer, Where::Shared, Where::Image, Where::Counter})
    for (const Stage stage : {Stage::Fragment, Stage::Compute, Stage::Vertex, Stage::Geometry})
      for (const bool isSigned : {false, true})
        if (where != Where::Buffer || stage == Stage::Vertex || stage == Stage::Geometry)
          runs.push_back({where, stage, isSigned});
  return runAll(context, runs,
                "heads and counters must stand in storage buffers, and be used in fragment or "
                "compute shaders, on this driver");
}

// ---- tickets
// -------------------------------------------------------------------------------------------------

struct TicketLoad {
  Stage stage = Stage::Fragment;
  int side = 256;
  uint32_t addresses = 1;
  int draws = 1;   // one after the other
  int frames = 1;  // with what there is read back in between
  bool atomic = true;

  uint32_t invocations() const { return static_cast<uint32_t>(side * side); }
};

struct Tickets {
  uint64_t asked = 0;
  uint64_t kept = 0;       // what the counters say
  uint64_t duplicate = 0;  // drawn more than once
  uint64_t missing = 0;    // below what was asked, but never drawn
  uint64_t astray = 0;     // counters that do not have the count that is theirs
  bool right() const { return duplicate + missing + astray == 0 && kept == asked; }
  std::string fault() const {
    return fmt::format("{} of {} tickets kept, {} twice, {} never", kept, asked, duplicate, missing);
  }
};

Tickets drawTickets(const Context& context, const TicketLoad& load) {
  const auto rounds = static_cast<uint32_t>(load.draws * load.frames);
  std::vector<uint32_t> expected(load.addresses);
  for (uint32_t id = 0; id < load.invocations(); ++id)
    expected[load.addresses == load.invocations()
                 ? id
                 : hash(id + static_cast<uint32_t>(context.seed)) % load.addresses] += rounds;
  const uint32_t capacity = *std::max_element(expected.begin(), expected.end());
  gl::ShaderDefines defines = {{"ADDRESSES", constant(load.addresses)}, {"CAPACITY", constant(capacity)}};
  if (!load.atomic) defines.emplace_back("WITHOUT_ATOMIC", "1");
  const gl::Buffer counters = zeroWords(context.device, load.addresses);
  const gl::Buffer drawn = zeroWords(context.device, size_t{load.addresses} * capacity);
  const gl::Buffer outcome = zeroWords(context.device, 1);
  counters.bindStorage(0);
  drawn.bindStorage(1);
  outcome.bindStorage(2);
  for (int frame = 0; frame < load.frames; ++frame) {
    for (int draw = 0; draw < load.draws; ++draw) invoke(context, "ticket", load.stage, load.side, defines);
    gl::storageBarrier();
    outcome.readValue<uint32_t>();
  }

  Tickets tickets{.asked = uint64_t{load.invocations()} * rounds};
  const auto count = counters.readValues<uint32_t>(load.addresses);
  const auto times = drawn.readValues<uint32_t>(size_t{load.addresses} * capacity);
  for (uint32_t a = 0; a < load.addresses; ++a) {
    tickets.kept += count[a];
    tickets.astray += count[a] != expected[a];
    for (uint32_t t = 0; t < capacity; ++t) {
      const uint32_t n = times[size_t{a} * capacity + t];
      if (n > 1) tickets.duplicate += n - 1;
      if (n == 0 && t < expected[a]) ++tickets.missing;
    }
  }
  return tickets;
}

constexpr const char* ticketMeaning = "nodes are lost or shared: no list can be built on this driver";

Result ticket(const Context& context) {
  const TicketLoad load{.side = context.scale == Scale::Full ? 1024 : 512};
  const Tickets tickets = drawTickets(context, load);
  Result result;
  result.figures = {{"tickets", static_cast<int64_t>(tickets.asked)}};
  if (!tickets.right()) return failed(tickets.fault(), ticketMeaning, result.figures);
  TicketLoad plain = load;
  plain.atomic = false;
  const Tickets control = drawTickets(context, plain);
  result.figures.emplace_back("kept by a plain increment", static_cast<int64_t>(control.kept));
  if (control.right()) return noPower("a plain increment lost nothing either", result.figures);
  return result;
}

Result ticketSpread(const Context& context) {
  const int side = context.scale == Scale::Full ? 512 : 128;
  Result result;
  for (const Stage stage : enginesStages)
    for (const uint32_t addresses : {1u, 16u, 4096u, static_cast<uint32_t>(side * side)}) {
      const Tickets tickets = drawTickets(
          context, {.stage = stage, .side = side, .addresses = addresses, .draws = 2, .frames = 3});
      if (!tickets.right())
        return failed(fmt::format("{} addresses, {}: {}", addresses, stageName(stage), tickets.fault()),
                      ticketMeaning, result.figures);
      result.figures.emplace_back(fmt::format("tickets from {} addresses, {}", addresses, stageName(stage)),
                                  static_cast<int64_t>(tickets.asked));
    }
  const Tickets control =
      drawTickets(context, {.stage = Stage::Compute, .side = side, .addresses = 16, .atomic = false});
  result.figures.emplace_back("kept by a plain increment at 16 addresses",
                              static_cast<int64_t>(control.kept));
  if (control.right()) return noPower("a plain increment lost nothing either", result.figures);
  return result;
}

// Can this driver lose an update at all? Without that, nothing that passes under contention means anything.
Result plainIncrement(const Context& context) {
  const int side = context.scale == Scale::Full ? 1024 : 512;
  Result result;
  bool lost = true;
  for (const Stage stage : enginesStages) {
    const bool atomic = context.mutant == "ATOMIC";
    const Tickets tickets = drawTickets(context, {.stage = stage, .side = side, .atomic = atomic});
    result.figures.emplace_back(fmt::format("kept of {}, {}", tickets.asked, stageName(stage)),
                                static_cast<int64_t>(tickets.kept));
    lost = lost && tickets.kept < tickets.asked;
  }
  if (!lost)
    return {Verdict::NoPower, "a plain increment loses nothing",
            "contention cannot be seen on this driver: what passes above and below proves little",
            result.figures};
  return result;
}

// ---- floats
// --------------------------------------------------------------------------------------------------

struct FloatSums {
  double asked = 0;
  double got = 0;
  uint32_t gaveUp = 0;
  uint32_t maxTries = 0;
};

FloatSums sumFloats(const Context& context, Stage stage, int side, uint32_t addresses, bool atomic) {
  gl::ShaderDefines defines = {{"ADDRESSES", constant(addresses)}};
  if (!atomic) defines.emplace_back("WITHOUT_ATOMIC", "1");
  const gl::Buffer sums = zeroWords(context.device, addresses);
  const gl::Buffer outcome = zeroWords(context.device, 2);
  sums.bindStorage(0);
  outcome.bindStorage(1);
  invoke(context, "float_sum", stage, side, defines);
  gl::storageBarrier();
  FloatSums found;
  for (int id = 0; id < side * side; ++id)
    found.asked += (1 + hash(static_cast<uint32_t>(id) + static_cast<uint32_t>(context.seed)) % 4) / 256.0;
  for (const float sum : sums.readValues<float>(addresses)) found.got += double{sum};
  const auto words = outcome.readValues<uint32_t>(2);
  found.gaveUp = words[0];
  found.maxTries = words[1];
  return found;
}

Result floatSum(const Context& context) {
  const int side = context.scale == Scale::Full ? 1024 : 256;
  Result result;
  for (const Stage stage : enginesStages)
    for (const uint32_t addresses : {1u, 64u}) {
      const FloatSums sums = sumFloats(context, stage, side, addresses, true);
      result.figures.emplace_back(fmt::format("most tries, {} sums, {}", addresses, stageName(stage)),
                                  int64_t{sums.maxTries});
      if (sums.got != sums.asked || sums.gaveUp != 0)
        return failed(fmt::format("{} sums, {}: {} instead of {}, {} gave up", addresses, stageName(stage),
                                  sums.got, sums.asked, sums.gaveUp),
                      "floats cannot be added up by compare-and-swap on this driver", result.figures);
    }
  const FloatSums control = sumFloats(context, Stage::Compute, side, 1, false);
  result.figures.emplace_back("plain sum of " + fmt::format("{}", control.asked), control.got);
  if (control.got == control.asked) return noPower("a plain sum lost nothing either", result.figures);
  return result;
}

// ---- awkward bits
// --------------------------------------------------------------------------------------------

bool isNan(uint32_t bits) {
  return (bits & 0x7fffffffu) > 0x7f800000u;
}

Result awkwardBits(const Context& context) {
  // Edges of the signed and the unsigned numbers; zeros, denormals, infinities, NaNs quiet and signalling.
  constexpr uint32_t words[] = {0,           1,           2,           0x7fffffffu, 0x80000000u, 0x80000001u,
                                0xffffffffu, 0xfffffffeu, 0x007fffffu, 0x807fffffu, 0x00800000u, 0x3f800000u,
                                0x7f800000u, 0xff800000u, 0x7fc00001u, 0x7f800001u, 0xffc12345u, 0x00012345u};
  std::vector<std::array<uint32_t, 2>> pairs;
  for (const uint32_t a : words)
    for (const uint32_t b : words) pairs.push_back({a, b});
  std::vector<uint32_t> four, two;
  for (const auto& [a, b] : pairs) {
    four.insert(four.end(), 4, a);
    two.insert(two.end(), 2, a);
  }
  gl::Device& device = context.device;
  const gl::Buffer in(device, "validation pairs", std::span<const std::array<uint32_t, 2>>(pairs));
  const gl::Buffer unsignedWords(device, "validation words", std::span<const uint32_t>(four));
  const gl::Buffer signedWords(device, "validation words", std::span<const uint32_t>(two));
  const gl::Buffer floats = zeroWords(device, two.size());
  const gl::Buffer returned = zeroWords(device, four.size());
  const gl::Buffer* bound[] = {&in, &unsignedWords, &signedWords, &floats, &returned};
  for (unsigned i = 0; i < std::size(bound); ++i) bound[i]->bindStorage(i);
  gl::dispatchLinear(probeProgram(context, {"bits.comp"}, {{"COUNT", constant(pairs.size())}}), pairs.size());
  gl::storageBarrier();

  const auto u = unsignedWords.readValues<uint32_t>(four.size());
  const auto s = signedWords.readValues<int32_t>(two.size());
  const auto f = floats.readValues<uint32_t>(two.size());
  const auto r = returned.readValues<uint32_t>(four.size());
  int64_t integers = 0, moved = 0, payloads = 0;
  for (size_t i = 0; i < pairs.size(); ++i) {
    const auto [a, b] = pairs[i];
    const auto signedA = static_cast<int32_t>(a), signedB = static_cast<int32_t>(b);
    integers += u[4 * i] != std::min(a, b) || u[4 * i + 1] != std::max(a, b) || u[4 * i + 2] != b ||
                u[4 * i + 3] != b || s[2 * i] != std::min(signedA, signedB) ||
                s[2 * i + 1] != std::max(signedA, signedB);
    for (size_t k = 0; k < 4; ++k) integers += r[4 * i + k] != a;
    for (size_t k = 0; k < 2; ++k) {
      if (isNan(a) && isNan(f[2 * i + k]))
        payloads += f[2 * i + k] != a;
      else
        moved += f[2 * i + k] != a;
    }
  }
  Result result;
  result.figures = {{"pairs", static_cast<int64_t>(pairs.size())},
                    {"wrong integers", integers},
                    {"floats changed by a move", moved},
                    {"NaNs with another payload", payloads}};
  if (integers + moved == 0) return result;
  return failed(fmt::format("{} integers wrong, {} floats changed by a move", integers, moved),
                integers != 0 ? "comparisons of indices and depths go wrong at their edges"
                              : "what is stored as a float is not always what is read: small depths become 0",
                result.figures);
}

// ---- lanes that take no part
// ---------------------------------------------------------------------------------

struct LiveCounts {
  std::array<uint32_t, 5> counts{};
  std::vector<uint32_t> pixels;
};

constexpr uint32_t cornerSide = 64;

LiveCounts expectedLive(uint32_t seed) {
  LiveCounts live{.pixels = std::vector<uint32_t>(cornerSide * cornerSide)};
  for (uint32_t n = 0; n + 1 < cornerSide; ++n)
    for (uint32_t y = 0; y <= n; ++y)
      for (uint32_t x = 0; x + y <= n; ++x) {
        const uint32_t pixel = y * cornerSide + x;
        const uint32_t word = hash(pixel + n * cornerSide * cornerSide + seed);
        ++live.counts[0];
        ++live.pixels[pixel];
        if (word % 5 == 0) continue;
        ++live.counts[1];
        if (word % 5 == 1) continue;
        ++live.counts[2];
        live.counts[3] += word % 5 == 2;
        live.counts[4] += (word >> 8) % 7;
      }
  return live;
}

LiveCounts countLive(const Context& context, bool withDiscard) {
  gl::ShaderDefines defines = {{"SIDE", constant(cornerSide)},
                               {"SEED", constant(static_cast<uint32_t>(context.seed))}};
  if (!withDiscard) defines.emplace_back("WITHOUT_DISCARD", "1");
  const gl::Buffer counts = zeroWords(context.device, 5);
  const gl::Buffer pixels = zeroWords(context.device, cornerSide * cornerSide);
  counts.bindStorage(0);
  pixels.bindStorage(1);
  const int side = static_cast<int>(cornerSide);
  const gl::Program& program = probeProgram(context, {"corners.vert", "inactive.frag"}, defines);
  const gl::Framebuffer nothing({side, side});
  gl::setDrawState({.program = &program, .target = &nothing, .viewport = {0, 0, side, side}});
  gl::drawGenerated(context.device, 3, cornerSide - 1);
  gl::storageBarrier();
  LiveCounts live{.pixels = pixels.readValues<uint32_t>(cornerSide * cornerSide)};
  const auto words = counts.readValues<uint32_t>(5);
  std::copy(words.begin(), words.end(), live.counts.begin());
  return live;
}

Result inactiveLanes(const Context& context) {
  const LiveCounts expected = expectedLive(static_cast<uint32_t>(context.seed));
  const LiveCounts live = countLive(context, true);
  constexpr const char* names[] = {"fragments", "after a return", "after a discard", "in a branch",
                                   "in a loop"};
  Result result;
  for (size_t i = 0; i < expected.counts.size(); ++i) {
    result.figures.emplace_back(names[i], int64_t{live.counts[i]});
    if (live.counts[i] == expected.counts[i]) continue;
    result.verdict = Verdict::Fail;
    result.finding += fmt::format("{}{}: {} instead of {}", result.finding.empty() ? "" : "; ", names[i],
                                  live.counts[i], expected.counts[i]);
  }
  if (live.pixels != expected.pixels && result.verdict == Verdict::Pass) {
    result.verdict = Verdict::Fail;
    result.finding = "fragments are counted at other pixels";
  }
  if (result.verdict == Verdict::Fail) {
    result.meaning = "lanes that take no part push nodes, or lanes that do push none";
    return result;
  }
  const LiveCounts control = countLive(context, false);
  result.figures.emplace_back("after a discard, without it", int64_t{control.counts[2]});
  if (control.counts == expected.counts)
    return noPower("without the discard the counts are the same", result.figures);
  return result;
}

}  // namespace

std::vector<Check> atomicsChecks() {
  const std::string group = "atomics";
  const std::vector<std::string> all = {"spinlock", "lockfree", "append", "count"};
  return {
      {.name = "ops",
       .group = group,
       .does = "eight operations on buffers in fragment and compute shaders: results and memory",
       .strategies = all,
       .mutants = {"NO_ATOMIC"},
       .run = operationsOfTheEngine},
      {.name = "ops-elsewhere",
       .group = group,
       .does = "the same in shared memory, images, counters, vertex and geometry shaders",
       .run = operationsElsewhere},
      {.name = "ticket",
       .group = group,
       .does = "every fragment draws a ticket from one counter: each ticket once",
       .strategies = all,
       .mutants = {"NO_ATOMIC"},
       .run = ticket},
      {.name = "ticket-spread",
       .group = group,
       .does = "the same from 1, 16, 4096 and all addresses, over draws, stages and frames",
       .strategies = all,
       .mutants = {"NO_ATOMIC"},
       .run = ticketSpread},
      {.name = "rmw-control",
       .group = group,
       .does = "a plain increment must lose updates, or contention cannot be seen here",
       .mutants = {"ATOMIC"},
       .run = plainIncrement},
      {.name = "float-cas",
       .group = group,
       .does = "floats added up by compare-and-swap: the exact sum, nobody gives up",
       .mutants = {"NO_ATOMIC"},
       .run = floatSum},
      {.name = "bits",
       .group = group,
       .does = "signs, denormals and NaNs through minimum, maximum, exchange and moves",
       .mutants = {"UNSIGNED"},
       .run = awkwardBits},
      {.name = "inactive-lanes",
       .group = group,
       .does = "helpers, returned and discarded fragments take no part in atomic operations",
       .strategies = all,
       .mutants = {"NO_BRANCH"},
       .run = inactiveLanes},
  };
}

}  // namespace sfumato::lists::validation
