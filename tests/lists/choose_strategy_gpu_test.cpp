// The engine keeps to what the validation found out about a driver.
#include <cstdlib>
#include <functional>
#include <map>
#include <string>

#include "base/error.h"
#include "lists/driver_verdict.h"
#include "lists/lists_gpu.h"
#include "tests/base/temporary_folder.h"
#include "tests/gl/test_device.h"

namespace sfumato::lists {
namespace {

// With a cache of its own, in place of the user's.
class ChooseStrategy : public tests::GpuTest {
 protected:
  void SetUp() override {
    GpuTest::SetUp();
    setenv("XDG_CACHE_HOME", cache_.path().c_str(), 1);
  }
  void TearDown() override {
    unsetenv("XDG_CACHE_HOME");
    GpuTest::TearDown();
  }

  void find(std::map<std::string, Trust, std::less<>> strategies) {
    const gl::DeviceNames& names = device().names();
    saveVerdict({{names.vendor, names.renderer, names.version}, std::move(strategies)});
  }

 private:
  const test::TemporaryFolder cache_{"choose_test"};
};

TEST_F(ChooseStrategy, CountsWhereNothingSpeaksAgainstIt) {
  EXPECT_EQ(chooseStrategy(device()), Strategy::Count);
  find({{"count", Trust::NotShown}});
  EXPECT_EQ(chooseStrategy(device()), Strategy::Count);
}

TEST_F(ChooseStrategy, RulesOutWhatTheValidationFoundUnsafe) {
  find({{"count", Trust::Unsafe}});
  EXPECT_EQ(chooseStrategy(device()), Strategy::Append);
  find({{"count", Trust::Unsafe}, {"append", Trust::Unsafe}});
  EXPECT_EQ(chooseStrategy(device()), Strategy::LockFree);
  find({{"count", Trust::Unsafe}, {"append", Trust::Unsafe}, {"lockfree", Trust::Unsafe}});
  EXPECT_EQ(chooseStrategy(device()), Strategy::SpinLock);
  find({{"count", Trust::Unsafe},
        {"append", Trust::Unsafe},
        {"lockfree", Trust::Unsafe},
        {"spinlock", Trust::Unsafe}});
  EXPECT_THROW(chooseStrategy(device()), base::Error);
}

}  // namespace
}  // namespace sfumato::lists
