#include "base/progress.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "base/log.h"
#include "base/parallel.h"

namespace sfumato::base {
namespace {

// What is written to stderr, which is no terminal while it is captured.
template <typename Act>
std::vector<std::string> linesOf(const Act& act) {
  testing::internal::CaptureStderr();
  act();
  std::istringstream text(testing::internal::GetCapturedStderr());
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

TEST(Progress, WritesALineForEveryTenPercent) {
  const auto lines = linesOf([] {
    Progress progress("march", 1000);
    for (int i = 0; i < 1000; ++i) progress.advance();
  });
  ASSERT_EQ(lines.size(), 10u);
  for (size_t i = 0; i < lines.size(); ++i) {
    const std::regex expected("march: " + std::to_string(10 * (i + 1)) + R"(% \d+\.\d s)");
    EXPECT_TRUE(std::regex_match(lines[i], expected)) << lines[i];
  }
}

TEST(Progress, EndsAtAHundredPercentHoweverFewTheSteps) {
  for (const long total : {1L, 3L, 7L}) {
    const auto lines = linesOf([&] {
      Progress progress("build", total);
      for (long i = 0; i < total; ++i) progress.advance();
    });
    ASSERT_FALSE(lines.empty());
    EXPECT_TRUE(lines.back().starts_with("build: 100%")) << lines.back();
    EXPECT_LE(lines.size(), 10u);
  }
}

TEST(Progress, CountsTheStepsOfAllThreads) {
  const auto lines = linesOf([] {
    Progress progress("trace", 5000);
    parallelFor(5000, [&](long) { progress.advance(); });
  });
  ASSERT_FALSE(lines.empty());
  EXPECT_EQ(
      std::count_if(lines.begin(), lines.end(), [](const auto& l) { return l.starts_with("trace: 100%"); }),
      1);
}

TEST(Progress, SaysNothingWhenQuiet) {
  setVerbosity(Verbosity::Quiet);
  const auto lines = linesOf([] {
    Progress progress("march", 10);
    progress.advance(10);
  });
  setVerbosity(Verbosity::Normal);
  EXPECT_TRUE(lines.empty());
}

}  // namespace
}  // namespace sfumato::base
