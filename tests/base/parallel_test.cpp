#include "base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

#include "base/error.h"

namespace sfumato::base {
namespace {

TEST(Parallel, CallsEveryIndexOnce) {
  for (const long count : {0L, 1L, 2L, 10'000L}) {
    std::vector<std::atomic<int>> calls(static_cast<size_t>(count));
    parallelFor(count, [&](long i) { ++calls[static_cast<size_t>(i)]; });
    for (const auto& n : calls) ASSERT_EQ(n, 1);
  }
}

TEST(Parallel, ThrowsOnWhatABodyThrows) {
  const auto act = [] {
    parallelFor(1000, [](long i) {
      if (i == 500) fail(ExitCode::Input, "number {}", i);
    });
  };
  EXPECT_THROW(act(), Error);
}

}  // namespace
}  // namespace sfumato::base
