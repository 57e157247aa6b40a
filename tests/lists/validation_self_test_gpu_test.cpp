#include "lists/validation/self_test_gpu.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "base/error.h"

namespace sfumato::lists::validation {
namespace {

TEST(ValidationSelfTest, EveryFaultIsInAShaderAsItIsNow) {
  std::vector<std::string> names;
  for (const Check& check : allChecks()) names.push_back(check.name);
  for (const EngineMutant& mutant : engineMutants()) {
    EXPECT_NE(mutated(mutant).find(mutant.replacement), std::string::npos) << mutant.name;
    EXPECT_NE(std::find(names.begin(), names.end(), mutant.check), names.end()) << mutant.check;
  }
}

TEST(ValidationSelfTest, SaysWhenAShaderNoLongerHasWhatAFaultReplaces) {
  EngineMutant gone = engineMutants().front();
  gone.text = "no such text";
  EngineMutant twice = engineMutants().front();
  twice.text = "listHeads";
  EngineMutant elsewhere = engineMutants().front();
  elsewhere.file = "lists/no_such.glsl";
  for (const EngineMutant& mutant : {gone, twice, elsewhere}) {
    try {
      mutated(mutant);
      ADD_FAILURE() << "no error for " << mutant.text;
    } catch (const base::Error& error) {
      EXPECT_EQ(error.exitCode, base::ExitCode::Bug);
    }
  }
}

TEST(ValidationSelfTest, AFaultIsSeenByAVerdictNotByAMutantThatDoesNotRun) {
  const auto seen = [](Verdict verdict, const char* finding) {
    return caught(Outcome{{}, {verdict, finding, {}, {}}, 0});
  };
  for (const Verdict verdict :
       {Verdict::Fail, Verdict::Hang, Verdict::Crash, Verdict::NoPower, Verdict::Skip})
    EXPECT_TRUE(seen(verdict, "3 nodes lost"));
  EXPECT_FALSE(seen(Verdict::Pass, ""));
  EXPECT_FALSE(seen(Verdict::Fail, "shader lists/x.comp: does not compile: …"));
  EXPECT_FALSE(seen(Verdict::Fail, "shader lists/x.comp: does not link: …"));
  EXPECT_FALSE(seen(Verdict::Crash, "its process ended with exit code 2: sfumato: error: …"));
}

TEST(ValidationChecks, HaveNamesOfTheirOwnAndKnownStrategies) {
  std::vector<std::string> names;
  for (const Check& check : allChecks()) {
    EXPECT_EQ(std::find(names.begin(), names.end(), check.name), names.end()) << check.name;
    names.push_back(check.name);
    EXPECT_EQ(check.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-"), std::string::npos)
        << check.name;
    EXPECT_FALSE(check.does.empty()) << check.name;
    EXPECT_EQ(check.does.find('\n'), std::string::npos) << check.name;
    for (const std::string& strategy : check.strategies)
      EXPECT_TRUE(strategy == "spinlock" || strategy == "lockfree" || strategy == "append" ||
                  strategy == "count")
          << strategy;
  }
}

}  // namespace
}  // namespace sfumato::lists::validation
