// Forward progress: may one invocation wait for another? GL promises nothing; the engine never needs it.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "gl/commands.h"
#include "lists/validation/probe_gpu.h"

namespace sfumato::lists::validation {
namespace {

// Below the 65,535 iterations at which some drivers end loops.
constexpr uint32_t pollLimit = 60000;

struct Waiting {
  std::string name;
  uint32_t groups = 1;
  uint32_t groupSize = 1;
  uint32_t waiter = 0;  // numbers of invocations
  uint32_t setter = 0;
};

Result wait(const Context& context, std::initializer_list<Waiting> directions, const std::string& meaning) {
  const size_t rounds = sized(context, 16, 64);
  Result result;
  for (const Waiting& waiting : directions) {
    const gl::Program& program = probeProgram(context, {"wait.comp"},
                                              {{"GROUP_SIZE", std::to_string(waiting.groupSize)},
                                               {"WAITER", std::to_string(waiting.waiter) + "u"},
                                               {"SETTER", std::to_string(waiting.setter) + "u"},
                                               {"POLL_LIMIT", std::to_string(pollLimit) + "u"}});
    size_t seen = 0;
    uint32_t polls = 0;
    for (size_t round = 0; round < rounds; ++round) {
      const gl::Buffer outcome = zeroWords(context.device, 3);
      outcome.bindStorage(0);
      gl::dispatch(program, {waiting.groups, 1, 1});
      gl::storageBarrier();
      const auto told = outcome.readValues<uint32_t>(3);
      seen += told[1];
      if (told[1] != 0) polls = std::max(polls, told[2]);
    }
    result.figures.emplace_back(waiting.name + ": rounds", static_cast<int64_t>(rounds));
    result.figures.emplace_back(waiting.name + ": seen", static_cast<int64_t>(seen));
    result.figures.emplace_back(waiting.name + ": most looks", polls);
    if (result.verdict == Verdict::Pass && seen < rounds) {
      result.verdict = Verdict::Fail;
      result.finding = fmt::format("{}: the flag was seen in {} of {} rounds, in {} looks", waiting.name,
                                   seen, rounds, pollLimit);
      result.meaning = meaning;
    }
  }
  return result;
}

Result waitGroup(const Context& context) {
  return wait(
      context,
      {{"workgroup 63 waits for 0", 64, 64, 63 * 64, 0}, {"workgroup 0 waits for 63", 64, 64, 0, 63 * 64}},
      "workgroups run in any order here, not side by side: who waits for another must give up in the end, as "
      "the "
      "engine's locks do");
}

Result waitLane(const Context& context) {
  return wait(context, {{"lane 1 waits for 0", 1, 32, 1, 0}, {"lane 0 waits for 1", 1, 32, 0, 1}},
              "a lane that waits for another of its vector waits for ever here: the engine's never do");
}

}  // namespace

std::vector<Check> progressChecks() {
  return {
      {"wait-group",
       "progress",
       "a workgroup waits for an earlier one and for a later one: for information",
       {},
       {"NO_FLAG"},
       waitGroup},
      {"wait-lane",
       "progress",
       "a lane waits for another lane of its vector: for information",
       {},
       {"NO_FLAG"},
       waitLane},
  };
}

}  // namespace sfumato::lists::validation
