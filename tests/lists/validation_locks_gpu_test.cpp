// The checks of locks, progress, the memory model, fragments, buffers and determinism on the device at hand.
// Whether two things ran at the same time is up to the operating system: a check may say that it had no
// power, but never fail. A fault in its shaders may never pass.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "lists/validation/check.h"
#include "tests/gl/test_device.h"

namespace sfumato::lists::validation {
namespace {

std::vector<Check> checksHere() {
  std::vector<Check> all;
  for (const auto& group : {locksChecks(), progressChecks(), memoryModelChecks(), rasterChecks(),
                            memoryChecks(), determinismChecks()})
    all.insert(all.end(), group.begin(), group.end());
  return all;
}

struct Case {
  Check check;
  std::string mutant;
};

std::vector<Case> checks() {
  std::vector<Case> all;
  for (const Check& check : checksHere()) all.push_back({check, {}});
  return all;
}

std::vector<Case> mutants() {
  std::vector<Case> all;
  for (const Check& check : checksHere())
    for (const std::string& mutant : check.mutants) all.push_back({check, mutant});
  return all;
}

std::string nameOf(const testing::TestParamInfo<Case>& info) {
  std::string text = info.param.check.name + (info.param.mutant.empty() ? "" : "_" + info.param.mutant);
  for (char& letter : text)
    if (letter == '-') letter = '_';
  return text;
}

class ValidationCheck : public tests::GpuTest, public testing::WithParamInterface<Case> {
 protected:
  Result run() { return GetParam().check.run({device(), 1, Scale::Small, GetParam().mutant, {}}); }
  bool onLlvmpipe() { return device().names().renderer.rfind("llvmpipe", 0) == 0; }
};

// What llvmpipe is known to do, beside passing.
const std::map<std::string, std::set<Verdict>> known = {
    {"lock-naive", {Verdict::Fail}},     // lanes of a vector wait for each other
    {"lock-pixel", {Verdict::NoPower}},  // a tile belongs to one thread
    {"interlock", {Verdict::Skip}},      // not there
    {"wait-group", {Verdict::Pass, Verdict::Fail}},
    {"wait-lane", {Verdict::Fail}},  // lockstep
    {"opaque-tiles", {Verdict::Fail}},
    // No barrier waits for the writes of its thread: seen now and then as SB or R.
    {"litmus-order", {Verdict::Pass, Verdict::NoPower, Verdict::Fail}},
};
const std::set<std::string> concurrent = {"lock-hash", "lock-publish", "litmus-coherence", "litmus-publish",
                                          "readback"};

TEST_P(ValidationCheck, JudgesThisDriver) {
  if (!onLlvmpipe()) GTEST_SKIP() << "what is expected is known of llvmpipe";
  const Result result = run();
  std::set<Verdict> expected = {Verdict::Pass};
  const std::string& check = GetParam().check.name;
  if (const auto found = known.find(check); found != known.end()) expected = found->second;
  if (concurrent.count(check) != 0) expected.insert(Verdict::NoPower);
  EXPECT_EQ(expected.count(result.verdict), 1u) << name(result.verdict) << ": " << result.finding;
  EXPECT_EQ(result.finding.find('\n'), std::string::npos);
  if (result.verdict != Verdict::Pass) {
    EXPECT_NE(result.finding, "");
    EXPECT_NE(result.meaning, "");
  }
}

using ValidationMutant = ValidationCheck;

TEST_P(ValidationMutant, IsSeen) {
  const Result result = run();
  EXPECT_TRUE(result.verdict == Verdict::Fail || result.verdict == Verdict::NoPower ||
              (result.verdict == Verdict::Skip && GetParam().check.name == "interlock"))
      << name(result.verdict) << ": " << result.finding;
}

INSTANTIATE_TEST_SUITE_P(Validation, ValidationCheck, testing::ValuesIn(checks()), nameOf);
INSTANTIATE_TEST_SUITE_P(Validation, ValidationMutant, testing::ValuesIn(mutants()), nameOf);

}  // namespace
}  // namespace sfumato::lists::validation
