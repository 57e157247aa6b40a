// Locks in shaders: do they keep others out, does everybody get in, and is what was written under one seen by
// the next holder?
#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <tuple>

#include "base/hash.h"
#include "gl/commands.h"
#include "gl/device.h"
#include "lists/validation/probe_gpu.h"

namespace sfumato::lists::validation {
namespace {

using base::hash;

// Tries for one lock before an invocation gives up: below the 65,535 iterations at which some drivers end
// loops.
constexpr uint32_t spinLimit = 30000;
// An operating system that takes a holder's thread away lets a few others run into the bound; where lanes
// wait for each other, whole vectors of them do.
constexpr double starvingShare = 0.01;

struct LockCase {
  std::string name;
  std::string acquire = "ACQUIRE_EXCHANGE";
  std::string lockIndex;  // GLSL: see lock.comp and lock.frag
  size_t locks = 1;
  bool fragments = false;  // of `patches`; else compute
  Patches patches;
  size_t count = 0;  // invocations of compute shaders
  int words = 4;     // that one lock guards
  std::string qualifier = "coherent";
  std::string shader = "lock.comp";
  std::string barrier = "memoryBarrier";

  size_t invocations() const { return fragments ? patches.fragments() : count; }
  // The longer a run, the likelier an operating system spreads its threads over its cores.
  void grow() {
    if (invocations() > 1u << 20) return;
    count *= 2;
    patches.layers *= 2;
  }
};

struct LockRun {
  uint32_t entered = 0;
  uint32_t gaveUp = 0;
  uint32_t torn = 0;
  uint32_t maxTries = 0;
  bool together = false;  // two places were seen to run at the same time
  uint32_t tries99 = 0;   // enough for 99 % of those who entered, rounded up to a power of two less one
  int64_t lost = 0;       // updates of the first guarded word that are not there
};

// `without`: "LOCK" or "BARRIER" leaves it out.
LockRun runOnce(const Context& context, const LockCase& probe, const std::string& without) {
  gl::ShaderDefines defines = {{probe.acquire, "1"},
                               {"LOCK_INDEX", probe.lockIndex},
                               {"SPIN_LIMIT", std::to_string(spinLimit) + "u"},
                               {"WORDS", std::to_string(probe.words) + "u"},
                               {"QUALIFIER", probe.qualifier},
                               {"BARRIER", probe.barrier}};
  if (!without.empty()) defines.emplace_back("WITHOUT_" + without, "1");
  const gl::Buffer locks = zeroWords(context.device, probe.locks);
  const gl::Buffer guarded = zeroWords(context.device, probe.locks * static_cast<size_t>(probe.words));
  const gl::Buffer outcome = zeroWords(context.device, 39);
  locks.bindStorage(0);
  guarded.bindStorage(1);
  outcome.bindStorage(2);
  if (probe.fragments) {
    drawPatches(
        context.device,
        probeProgram(context, {"layers.vert", "lock.frag"}, gl::joined(defines, probe.patches.defines())),
        probe.patches);
  } else {
    defines.emplace_back("COUNT", std::to_string(probe.count) + "u");
    gl::dispatchLinear(probeProgram(context, {probe.shader}, defines), probe.count);
  }
  gl::storageBarrier();
  const auto told = outcome.readValues<uint32_t>(39);
  LockRun result{
      .entered = told[0], .gaveUp = told[1], .torn = told[2], .maxTries = told[3], .together = told[5] != 0};
  uint64_t within = 0;
  for (size_t i = 0; i < 32 && within * 100 < uint64_t{result.entered} * 99; ++i) {
    within += told[7 + i];
    result.tries99 = static_cast<uint32_t>((uint64_t{2} << i) - 1);
  }
  const auto values = guarded.readValues<uint32_t>(probe.locks * static_cast<size_t>(probe.words));
  result.lost = result.entered;
  for (size_t i = 0; i < values.size(); i += static_cast<size_t>(probe.words)) result.lost -= values[i];
  return result;
}

// A thread that loses its core while it holds a lock keeps others waiting, now and then; lanes that wait for
// each other do so every time. So the run in which the fewest gave up counts.
constexpr int fairTries = 4;

LockRun run(const Context& context, const LockCase& probe, const std::string& without = {}) {
  const auto invocations = static_cast<double>(probe.invocations());
  LockRun best = runOnce(context, probe, without);
  for (int i = 1; i < fairTries && without.empty() && best.gaveUp > starvingShare * invocations; ++i) {
    const bool broken = best.lost != 0 || best.torn != 0 || best.entered + best.gaveUp != probe.invocations();
    if (broken) break;
    const LockRun again = runOnce(context, probe, without);
    if (again.gaveUp < best.gaveUp) best = again;
  }
  return best;
}

// What several runs of one check come to.
struct Tally {
  int64_t invocations = 0;
  int64_t lost = 0;
  int64_t torn = 0;
  int64_t vanished = 0;  // invocations that neither entered nor gave up
  int64_t gaveUp = 0;
  int64_t maxTries = 0;
  int64_t tries99 = 0;
  int64_t runs = 0;
  int64_t together = 0;
  std::string broken;    // the first case in which updates or invocations were lost
  std::string starving;  // the first case in which too many gave up

  void add(const LockCase& probe, const LockRun& run) {
    invocations += static_cast<int64_t>(probe.invocations());
    lost += run.lost;
    ++runs;
    together += run.together;
    torn += run.torn;
    gaveUp += run.gaveUp;
    maxTries = std::max<int64_t>(maxTries, run.maxTries);
    tries99 = std::max<int64_t>(tries99, run.tries99);
    const int64_t gone = static_cast<int64_t>(probe.invocations()) - run.entered - run.gaveUp;
    vanished += gone;
    if (broken.empty() && gone != 0)
      broken = fmt::format("{}: {} of {} invocations vanished on their way through the section", probe.name,
                           gone, probe.invocations());
    else if (broken.empty() && (run.lost != 0 || run.torn != 0))
      broken = fmt::format("{}: {} of {} updates lost, {} sections found the words of two others", probe.name,
                           run.lost, run.entered, run.torn);
    if (starving.empty() && run.gaveUp > starvingShare * static_cast<double>(probe.invocations()))
      starving = fmt::format("{}: {} of {} invocations never got their lock in {} tries", probe.name,
                             run.gaveUp, probe.invocations(), spinLimit);
  }
  bool bad() const { return !broken.empty() || !starving.empty(); }

  Result result(std::string brokenMeans, std::string starvingMeans) const {
    Result result;
    result.figures = {
        {"invocations", invocations},   {"lost", lost},      {"torn", torn},
        {"vanished", vanished},         {"gave up", gaveUp}, {"max tries", maxTries},
        {"99 % within tries", tries99}, {"runs", runs},      {"runs seen side by side", together}};
    if (!broken.empty()) {
      result.verdict = Verdict::Fail;
      result.finding = broken;
      result.meaning = std::move(brokenMeans);
    } else if (!starving.empty()) {
      result.verdict = Verdict::Fail;
      result.finding = starving;
      result.meaning = std::move(starvingMeans);
    } else if (gaveUp > 0) {
      result.finding =
          fmt::format("{} of {} invocations gave up after {} tries", gaveUp, invocations, spinLimit);
      result.meaning = "a bounded spin needs a fallback that loses nothing; the engine has one";
    }
    return result;
  }
};

Result noPower(Result result, std::string finding, std::string meaning) {
  if (result.verdict != Verdict::Pass) return result;
  result.verdict = Verdict::NoPower;
  result.finding = std::move(finding);
  result.meaning = std::move(meaning);
  return result;
}

const char* const excludesNobody = "locks do not keep others out here: build lists without them";
const char* const waitsForItself =
    "who wants a lock can wait for ever (lock-barrier may say why): build lists without locks";
const std::vector<std::string> allAcquires = {"ACQUIRE_EXCHANGE", "ACQUIRE_COMPARE", "ACQUIRE_HEAD"};

std::string acquireName(const std::string& acquire) {
  return acquire == "ACQUIRE_EXCHANGE"  ? "exchange"
         : acquire == "ACQUIRE_COMPARE" ? "compare"
                                        : "head is the lock";
}

// A few quads of fragments, each quad on one lock: where lanes wait for each other it shows at once, before
// larger runs would take minutes.
LockCase quadProbe() {
  return {.name = "fragments of a quad",
          .lockIndex =
              "(id / (PATCH * PATCH)) * (PATCH * PATCH / 4u) + pixel.y / 2u * (PATCH / 2u) + pixel.x / 2u",
          .locks = 64,
          .fragments = true,
          .patches = {.patch = 8}};
}

Result lockNaive(const Context& context) {
  const LockCase probe{
      .name = "64 invocations on one lock", .lockIndex = "0u", .count = 64, .shader = "lock_naive.comp"};
  const LockRun locked = run(context, probe);
  const LockRun control = run(context, probe, "LOCK");
  Tally tally;
  tally.add(probe, locked);
  Result result = tally.result(excludesNobody,
                               "a lock that is taken before its section never comes free within a vector of "
                               "lanes: the section stands inside the loop, as the engine's does");
  result.figures.emplace_back("lost without the lock", control.lost);
  if (control.lost == 0)
    return noPower(result, "no update was lost without the lock",
                   "invocations of one workgroup do not run at the same time here");
  return result;
}

Result lockPixel(const Context& context) {
  const Patches patches{.patch = sized(context, 32, 64), .layers = sized(context, 8, 8)};
  Tally tally;
  int64_t lostWithout = 0;
  for (const std::string& acquire : allAcquires) {
    const LockCase probe{.name = "one lock a pixel, " + acquireName(acquire),
                         .acquire = acquire,
                         .lockIndex = "id",
                         .locks = patches.pixels(),
                         .fragments = true,
                         .patches = patches};
    tally.add(probe, run(context, probe));
    if (tally.bad()) break;
    // What is lost without the lock does not depend on how it is taken.
    if (lostWithout == 0 && acquire == allAcquires.front()) lostWithout = run(context, probe, "LOCK").lost;
  }
  Result result = tally.result(excludesNobody, waitsForItself);
  result.figures.emplace_back("lost without the lock", lostWithout);
  if (lostWithout == 0)
    return noPower(result, "no update was lost without the lock: fragments of one pixel never ran at once",
                   "nothing, good or bad: lock-hash makes locks contend across tiles");
  return result;
}

Result lockGlobal(const Context& context) {
  const bool full = context.scale == Scale::Full;
  Tally tally;
  int64_t lostWithout = 0;
  // Few at first, in case nobody gets through.
  for (const Patches& patches :
       {Patches{.patch = 8}, Patches{.grid = full ? 16u : 2u, .patch = sized(context, 32, 64)}}) {
    const LockCase probe{.name = fmt::format("{} fragments on one lock", patches.fragments()),
                         .lockIndex = "0u",
                         .fragments = true,
                         .patches = patches};
    tally.add(probe, run(context, probe));
    if (tally.bad()) break;
    lostWithout += run(context, probe, "LOCK").lost;
  }
  Result result = tally.result(excludesNobody, waitsForItself);
  result.figures.emplace_back("lost without the lock", lostWithout);
  if (lostWithout == 0) return noPower(result, "no update was lost without the lock", "nothing, good or bad");
  return result;
}

Result lockHash(const Context& context) {
  const Patches patches{.patch = sized(context, 32, 64), .layers = sized(context, 4, 8)};
  Tally tally;
  int64_t lostInCompute = 0;
  int64_t lostInFragments = 0;
  for (const std::string& acquire : allAcquires) {
    std::vector<LockCase> cases = {quadProbe()};
    for (const size_t locks : {1, 7, 64, 4096})
      for (const bool fragments : {true, false})
        cases.push_back({.name = fmt::format("{} locks for {}", locks, fragments ? "fragments" : "compute"),
                         .lockIndex = "hash(id) % (uint(guarded.length()) / WORDS)",
                         .locks = locks,
                         .fragments = fragments,
                         .patches = patches,
                         .count = patches.fragments()});
    for (LockCase& probe : cases) {
      probe.name += ", " + acquireName(acquire);
      probe.acquire = acquire;
      tally.add(probe, run(context, probe));
      if (tally.bad()) break;
      if (acquire == allAcquires.front())
        (probe.fragments ? lostInFragments : lostInCompute) += run(context, probe, "LOCK").lost;
    }
    if (tally.bad()) break;
  }
  // No two lanes of a vector share a lock here: what is lost is lost between workgroups, or between tiles.
  int64_t lostBetween = 0;
  LockCase between[] = {
      {.name = "lanes of workgroups", .lockIndex = "id % 64u", .locks = 64, .count = patches.fragments()},
      {.name = "lanes of tiles",
       .lockIndex = "pixel.y * PATCH + pixel.x",
       .locks = patches.pixels(),
       .fragments = true,
       .patches = patches}};
  if (!tally.bad())
    untilSeen(context, 0.8, [&] {
      for (LockCase& probe : between) {
        tally.add(probe, run(context, probe));
        lostBetween += run(context, probe, "LOCK").lost;
        probe.grow();
      }
      return tally.bad() || lostBetween > 0;
    });
  Result result = tally.result(excludesNobody, waitsForItself);
  result.figures.emplace_back("lost without the lock, compute", lostInCompute);
  result.figures.emplace_back("lost without the lock, fragments", lostInFragments);
  result.figures.emplace_back("lost without the lock, between workgroups or tiles", lostBetween);
  if (lostInCompute == 0 || lostInFragments == 0 || lostBetween == 0)
    return noPower(result,
                   fmt::format("no update was lost without the lock {}",
                               lostInCompute == 0     ? "in compute shaders"
                               : lostInFragments == 0 ? "in fragment shaders"
                                                      : "between workgroups or tiles"),
                   "nothing, good or bad: such invocations did not run at the same time here");
  return result;
}

Result barrierInSection(const Context& context) {
  Tally tally;
  std::string bad;
  const char* const barriers[] = {"memoryBarrier", "memoryBarrierBuffer", "memoryBarrierImage",
                                  "memoryBarrierShared", "groupMemoryBarrier"};
  for (const char* barrier : barriers) {
    const LockCase probe{.name = fmt::format("{}()", barrier),
                         .lockIndex = "hash(id) % 7u",
                         .locks = 7,
                         .count = 1024,
                         .barrier = barrier};
    const LockRun locked = run(context, probe);
    tally.add(probe, locked);
    const bool right = locked.entered >= probe.count - probe.count / 100 && locked.lost == 0;
    if (!right) bad += (bad.empty() ? "" : ", ") + probe.name;
  }
  const std::string meaning =
      "before an unlock in a compute shader, " + bad + " cannot be used: it stops or ends its invocations";
  Result result = tally.result(meaning, meaning);
  for (const char* barrier : barriers)
    result.figures.emplace_back(
        fmt::format("{}()", barrier),
        bad.find(fmt::format("{}()", barrier)) == std::string::npos ? "right" : "wrong");
  const LockCase plain{.lockIndex = "hash(id) % 7u", .locks = 7, .count = 1024};
  const int64_t lostWithout = run(context, plain, "LOCK").lost;
  result.figures.emplace_back("lost without the lock", lostWithout);
  if (lostWithout == 0) return noPower(result, "no update was lost without the lock", "nothing, good or bad");
  return result;
}

Result lockPublish(const Context& context) {
  LockCase probe{.lockIndex = "id / 8u % 7u", .locks = 7, .count = sized(context, 16384, 65536), .words = 16};
  Tally tally;
  int64_t tornWithoutBarrier = 0;
  int64_t tornWithoutLock = 0;
  int64_t tornPlain = 0;
  const bool seen = untilSeen(context, 0.8, [&] {
    for (const char* qualifier : {"coherent", "volatile", ""}) {
      probe.name = probe.qualifier = qualifier;
      const LockRun locked = run(context, probe);
      if (*qualifier == '\0') {
        tornPlain += locked.torn;  // what is plain need not be seen: for information
        continue;
      }
      tally.add(probe, locked);
      if (tally.bad()) return true;
      const LockRun loose = run(context, probe, "BARRIER");
      tornWithoutBarrier += loose.torn + loose.lost;
      tornWithoutLock += run(context, probe, "LOCK").torn;
    }
    probe.grow();
    return tornWithoutLock > 0 && tornWithoutBarrier > 0;
  });
  Result result =
      tally.result("what is written under a lock is not whole for its next holder: build lists without locks",
                   waitsForItself);
  result.figures.emplace_back("torn without lock", tornWithoutLock);
  result.figures.emplace_back("torn without barrier", tornWithoutBarrier);
  result.figures.emplace_back("torn without coherent", tornPlain);
  if (seen) return result;
  if (tornWithoutLock == 0)
    return noPower(result, "no set of words was torn without the lock",
                   "nothing, good or bad: holders did not run at the same time here");
  return noPower(result, "no set of words was torn, with the barrier before the unlock or without it",
                 "locks work; that the barrier is needed cannot be shown here: keep it for other drivers");
}

// What every account should hold after lock_two.comp: as many coins more or less as it was sent, modulo 2^32.
std::vector<uint32_t> balances(uint32_t transfers, uint32_t accounts) {
  std::vector<uint32_t> expected(accounts, 0);
  for (uint32_t id = 0; id < transfers; ++id) {
    const uint32_t from = hash(id) % accounts;
    const uint32_t to = (from + 1 + hash(id + transfers) % (accounts - 1)) % accounts;
    --expected[from];
    ++expected[to];
  }
  return expected;
}

Result lockTwo(const Context& context) {
  const auto count = static_cast<uint32_t>(sized(context, 8192, 65536));
  Result result;
  int64_t wrongWithout = 0;
  for (const uint32_t accounts : {2u, 13u, 1000u}) {
    const auto expected = balances(count, accounts);
    const auto transfer = [&](const gl::ShaderDefines& more) {
      gl::ShaderDefines defines = {{"ACQUIRE_EXCHANGE", "1"},
                                   {"SPIN_LIMIT", std::to_string(spinLimit) + "u"},
                                   {"WORDS", "1u"},
                                   {"QUALIFIER", "coherent"},
                                   {"BARRIER", "memoryBarrier"},
                                   {"COUNT", std::to_string(count) + "u"},
                                   {"LOCKS", std::to_string(accounts) + "u"}};
      defines.insert(defines.end(), more.begin(), more.end());
      const gl::Buffer locks = zeroWords(context.device, accounts);
      const gl::Buffer guarded = zeroWords(context.device, accounts);
      const gl::Buffer outcome = zeroWords(context.device, 39);
      locks.bindStorage(0);
      guarded.bindStorage(1);
      outcome.bindStorage(2);
      gl::dispatchLinear(probeProgram(context, {"lock_two.comp"}, defines), count);
      gl::storageBarrier();
      const auto held = guarded.readValues<uint32_t>(accounts);
      int64_t wrong = 0;
      for (uint32_t i = 0; i < accounts; ++i) wrong += held[i] != expected[i];
      const auto told = outcome.readValues<uint32_t>(6);
      return std::pair(wrong, LockRun{.entered = told[0], .gaveUp = told[1], .maxTries = told[3]});
    };
    auto [wrong, locked] = transfer({});
    for (int i = 1; i < fairTries && locked.gaveUp > starvingShare * count; ++i)
      if (const auto again = transfer({}); again.second.gaveUp < locked.gaveUp)
        std::tie(wrong, locked) = again;
    wrongWithout += transfer({{"WITHOUT_LOCK", "1"}}).first;
    result.figures.emplace_back(fmt::format("{} accounts: wrong", accounts), wrong);
    result.figures.emplace_back(fmt::format("{} accounts: gave up", accounts), locked.gaveUp);
    result.figures.emplace_back(fmt::format("{} accounts: max tries", accounts), locked.maxTries);
    if (result.verdict != Verdict::Pass) continue;
    if (locked.gaveUp > starvingShare * count) {
      result.verdict = Verdict::Fail;
      result.finding = fmt::format("{} of {} invocations never got both of {} locks in {} tries",
                                   locked.gaveUp, count, accounts, spinLimit);
      result.meaning = "sections under two locks do not end here: the engine holds one at a time";
    } else if (locked.gaveUp > 0) {
      // What they did not move is missing: the sums tell nothing.
      result.finding = fmt::format("{} of {} invocations gave up", locked.gaveUp, count);
      result.meaning = "a bounded spin needs a fallback that loses nothing; the engine has one";
    } else if (wrong != 0) {
      result.verdict = Verdict::Fail;
      result.finding = fmt::format("{} of {} accounts hold the wrong sum", wrong, accounts);
      result.meaning = excludesNobody;
    }
  }
  result.figures.emplace_back("wrong without the locks", wrongWithout);
  if (wrongWithout == 0)
    return noPower(result, "no account was wrong without the locks", "nothing, good or bad");
  return result;
}

Result interlock(const Context& context) {
  const char* const extension = "GL_ARB_fragment_shader_interlock";
  if (!context.device.has(extension))
    return {Verdict::Skip, fmt::format("no {}", extension),
            "critical sections of a pixel need locks or atomics here"};
  constexpr Patches patches{.grid = 4, .patch = 64, .layers = 16};
  Result result;
  int64_t wrongWithout = 0;
  for (const char* mode : {"pixel_interlock_ordered", "pixel_interlock_unordered"}) {
    const auto draw = [&](const gl::ShaderDefines& more) {
      gl::ShaderDefines defines = patches.defines();
      defines.emplace_back("MODE", mode);
      defines.insert(defines.end(), more.begin(), more.end());
      const gl::Buffer pixels = zeroWords(context.device, patches.pixels() * 2);
      const gl::Buffer outcome = zeroWords(context.device, 1);
      pixels.bindStorage(0);
      outcome.bindStorage(1);
      drawPatches(context.device, probeProgram(context, {"layers.vert", "interlock.frag"}, defines), patches);
      gl::storageBarrier();
      const auto values = pixels.readValues<uint32_t>(patches.pixels() * 2);
      int64_t lost = 0;
      for (size_t i = 0; i < values.size(); i += 2) lost += static_cast<int64_t>(patches.layers) - values[i];
      return std::pair(lost, int64_t{outcome.readValue<uint32_t>()});
    };
    const auto [lost, disorder] = draw({});
    const auto [lostWithout, disorderWithout] = draw({{"WITHOUT_INTERLOCK", "1"}});
    const bool ordered = std::string_view(mode) == "pixel_interlock_ordered";
    wrongWithout += lostWithout;
    result.figures.emplace_back(std::string(mode) + ": lost", lost);
    result.figures.emplace_back(std::string(mode) + ": out of order", disorder);
    if (result.verdict == Verdict::Pass && (lost != 0 || (ordered && disorder != 0))) {
      result.verdict = Verdict::Fail;
      result.finding = fmt::format("{}: {} of {} updates lost, {} out of order", mode, lost,
                                   patches.fragments(), disorder);
      result.meaning = "interlocked sections cannot be trusted here: the engine does not use them";
    }
  }
  result.figures.emplace_back("lost without interlock", wrongWithout);
  if (wrongWithout == 0)
    return noPower(result, "no update was lost without the interlock", "nothing, good or bad");
  return result;
}

}  // namespace

std::vector<Check> locksChecks() {
  return {
      {"lock-naive",
       "locks",
       "waits for a lock before its section, 64 invocations on one lock: for information",
       {},
       {"NO_LOCK"},
       lockNaive},
      {"lock-pixel",
       "locks",
       "a lock for every pixel, 8 layers, taken in three ways: for information",
       {},
       {"NO_LOCK"},
       lockPixel},
      {"lock-global", "locks", "every fragment on one lock: who starves?", {}, {"NO_LOCK"}, lockGlobal},
      {"lock-hash",
       "locks",
       "1, 7, 64 and 4096 locks contended across tiles, quads and workgroups, taken in three ways",
       {"spinlock"},
       {"NO_LOCK"},
       lockHash},
      {"lock-barrier",
       "locks",
       "a section in a compute shader with each of the five memory barriers: for information",
       {},
       {"NO_LOCK"},
       barrierInSection},
      {"lock-publish",
       "locks",
       "16 words written under a lock are whole for the next holder",
       {"spinlock"},
       {"NO_LOCK", "NO_BARRIER"},
       lockPublish},
      {"lock-two",
       "locks",
       "sections under two locks, in the order of their numbers, end and exclude",
       {},
       {"NO_LOCK", "ONE_LOCK"},
       lockTwo},
      {"interlock",
       "locks",
       "GL_ARB_fragment_shader_interlock: sections of a pixel one by one, and in order",
       {},
       {"NO_INTERLOCK"},
       interlock},
  };
}

}  // namespace sfumato::lists::validation
