#include "base/error.h"

#include <gtest/gtest.h>

namespace sfumato::base {
namespace {

TEST(Error, CarriesItsLineAndItsExitCode) {
  try {
    fail(ExitCode::Input, "{}: no grid {}", "smoke.vdb", 3);
    FAIL() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "smoke.vdb: no grid 3");
    EXPECT_EQ(error.exitCode, ExitCode::Input);
  }
}

TEST(Error, ExitCodesAreWhatTheManualStates) {
  EXPECT_EQ(static_cast<int>(ExitCode::Done), 0);
  EXPECT_EQ(static_cast<int>(ExitCode::CheckFailed), 1);
  EXPECT_EQ(static_cast<int>(ExitCode::Usage), 2);
  EXPECT_EQ(static_cast<int>(ExitCode::Input), 3);
  EXPECT_EQ(static_cast<int>(ExitCode::NoGl), 4);
  EXPECT_EQ(static_cast<int>(ExitCode::Memory), 5);
  EXPECT_EQ(static_cast<int>(ExitCode::Bug), 6);
}

TEST(Error, ACheckThatFailsIsOurBug) {
  check(true, "never seen");
  try {
    check(false, "the count is even");
    FAIL() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_EQ(error.exitCode, ExitCode::Bug);
    EXPECT_NE(std::string(error.what()).find("the count is even"), std::string::npos);
  }
}

}  // namespace
}  // namespace sfumato::base
