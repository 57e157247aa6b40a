#include "lists/driver_verdict.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <fstream>

#include "base/error.h"
#include "tests/base/temporary_folder.h"

namespace sfumato::lists {
namespace {

namespace fs = std::filesystem;

// A cache of its own, in place of the user's.
class DriverVerdictTest : public testing::Test {
 protected:
  void SetUp() override { setenv("XDG_CACHE_HOME", cache_.path().c_str(), 1); }
  void TearDown() override { unsetenv("XDG_CACHE_HOME"); }

  const test::TemporaryFolder cache_{"verdict_test"};
  const Driver driver_{"Maker", "Renderer \"X\"", "4.5 build 7"};
  const DriverVerdict verdict_{
      driver_, {{"spinlock", Trust::Unsafe}, {"lockfree", Trust::NotShown}, {"append", Trust::Safe}}};
};

TEST_F(DriverVerdictTest, IsReadAsItWasWritten) {
  EXPECT_FALSE(loadVerdict(driver_).has_value());
  saveVerdict(verdict_);
  EXPECT_TRUE(verdictFile(driver_).string().starts_with(cache_.path().string()));
  const auto read = loadVerdict(driver_);
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->driver, driver_);
  EXPECT_EQ(read->strategies, verdict_.strategies);
}

TEST_F(DriverVerdictTest, OnlyWhatWasShownWrongIsNotTrusted) {
  EXPECT_FALSE(verdict_.trusted("spinlock"));
  EXPECT_TRUE(verdict_.trusted("lockfree"));
  EXPECT_TRUE(verdict_.trusted("append"));
  EXPECT_TRUE(verdict_.trusted("count"));  // of which nothing is known
}

TEST_F(DriverVerdictTest, AnotherVersionIsAnotherDriver) {
  saveVerdict(verdict_);
  Driver other = driver_;
  other.version = "4.5 build 8";
  EXPECT_FALSE(loadVerdict(other).has_value());
  // Even where its verdict would stand in the same file.
  fs::copy_file(verdictFile(driver_), verdictFile(other));
  EXPECT_FALSE(loadVerdict(other).has_value());
}

TEST_F(DriverVerdictTest, ADamagedFileIsNoVerdict) {
  saveVerdict(verdict_);
  std::string whole;
  std::getline(std::ifstream(verdictFile(driver_)), whole, '\0');
  const auto changed = [&](const char* from, const char* to) {
    std::string text = whole;
    return text.replace(text.find(from), std::strlen(from), to);
  };
  const std::string unknown = changed("unsafe", "purple");
  const std::string olderProgram = changed("\"program\": \"", "\"program\": \"x");
  for (const std::string& text : {std::string(), whole.substr(0, whole.size() / 2), std::string("[]"),
                                  std::string("{}"), std::string(100000, '['), unknown, olderProgram}) {
    std::ofstream(verdictFile(driver_), std::ios::trunc) << text;
    EXPECT_FALSE(loadVerdict(driver_).has_value()) << text.substr(0, 40);
  }
  fs::remove(verdictFile(driver_));
  fs::create_directory(verdictFile(driver_));
  EXPECT_FALSE(loadVerdict(driver_).has_value());
}

TEST_F(DriverVerdictTest, SaysWhenItCannotBeKept) {
  fs::remove_all(cache_.path());
  std::ofstream(cache_.path()) << "a file, not a folder";
  try {
    saveVerdict(verdict_);
    FAIL() << "no error";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.exitCode, base::ExitCode::Input);
  }
}

}  // namespace
}  // namespace sfumato::lists
