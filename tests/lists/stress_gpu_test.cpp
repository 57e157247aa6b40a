// The measured run of `sfumato stress`: figures that are known in advance, and no complaint of the driver.
#include "lists/stress/stress_gpu.h"

#include "base/error.h"
#include "tests/gl/test_device.h"

namespace sfumato::lists::stress {
namespace {

constexpr Strategy strategies[] = {Strategy::SpinLock, Strategy::LockFree, Strategy::Append, Strategy::Count};

class StressGpu : public tests::GpuTest {};

TEST_F(StressGpu, MeasuresWhatIsKnownOfALoad) {
  for (const Strategy strategy : strategies) {
    const uint32_t words = strategy == Strategy::Append ? 0 : 3;
    const Load load{.width = 40, .height = 30, .layers = 7, .payloadWords = words, .seed = 5};
    const Measured measured = measure(device(), load, {.strategy = strategy});
    EXPECT_TRUE(measured.findings.good()) << measured.findings.fault;
    EXPECT_EQ(measured.statistics.strategy, strategy);  // none was distrusted
    EXPECT_EQ(measured.statistics.distrusted, 0);
    EXPECT_EQ(measured.statistics.cells, 1200u);
    EXPECT_EQ(measured.statistics.demand, 8400u);
    EXPECT_EQ(measured.statistics.stored, 8400u);
    EXPECT_EQ(measured.statistics.longest, 7u);
    EXPECT_EQ(measured.statistics.lengths[4], 1200u);  // 5 to 8 nodes
    EXPECT_EQ(measured.statistics.nodeBytes, 8 + words * 4);
    EXPECT_EQ(measured.lookups, 1200u * lookupsPerCell);
    EXPECT_GT(measured.buildSeconds, 0);
    EXPECT_GT(measured.resolveSeconds, 0);
    EXPECT_GT(measured.lookupSeconds, 0);
  }
}

TEST_F(StressGpu, FindsTheSameNodesInWindows) {
  for (const Distribution distribution : {Distribution::Uniform, Distribution::Hair}) {
    const Load load{.width = 64, .height = 48, .layers = 12, .distribution = distribution, .seed = 6};
    for (const Strategy strategy : strategies) {
      const size_t whole = measure(device(), load, {.strategy = strategy}).statistics.bytes;
      const Measured measured = measure(device(), load, {.strategy = strategy, .budgetBytes = whole / 3});
      EXPECT_TRUE(measured.findings.good()) << measured.findings.fault;
      EXPECT_GE(measured.statistics.windows, 3);
      EXPECT_LE(measured.statistics.bytes, whole / 3);
    }
  }
}

// Windows shrink where lists are long, and grow again behind: few more than the budget goes into the whole.
TEST_F(StressGpu, IsBuiltInFewWindowsWhereverItIsCrowded) {
  for (const Distribution distribution : {Distribution::HotSpot, Distribution::Hair}) {
    const Load load{.width = 128, .height = 128, .layers = 8, .distribution = distribution, .seed = 7};
    for (const Strategy strategy : strategies) {
      const size_t whole = measure(device(), load, {.strategy = strategy}).statistics.predictedBytes;
      const Measured measured = measure(device(), load, {.strategy = strategy, .budgetBytes = whole / 8});
      EXPECT_TRUE(measured.findings.good()) << measured.findings.fault;
      EXPECT_GE(measured.statistics.windows, 8);
      EXPECT_LE(measured.statistics.windows, 16)
          << lists::strategies().nameOf(strategy) << ", " << distributions().nameOf(distribution);
    }
  }
}

// A list that leaves no room for those beside it gets a window of its own.
TEST_F(StressGpu, BuildsOneLongListWithinABudgetThatItNearlyFills) {
  const Load load{.width = 64, .height = 64, .layers = 32, .distribution = Distribution::OneCell};
  for (const auto& [strategy, budget] : {std::pair(Strategy::Count, 30000u), {Strategy::Append, 68000u}}) {
    const Measured measured = measure(device(), load, {.strategy = strategy, .budgetBytes = budget});
    EXPECT_TRUE(measured.findings.good()) << measured.findings.fault;
    EXPECT_EQ(measured.statistics.longest, 2048u);
    EXPECT_LE(measured.statistics.bytes, budget);
  }
}

TEST_F(StressGpu, LeavesTheErrorToTheCaller) {
  const Load load{.width = 64, .height = 64, .layers = 64, .distribution = Distribution::OneCell};
  try {
    measure(device(), load, {.strategy = Strategy::Count, .budgetBytes = 20000});
    FAIL() << "no error";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.exitCode, base::ExitCode::Memory);
  }
  // And the next one works.
  EXPECT_TRUE(measure(device(), load, {.strategy = Strategy::Count}).findings.good());
}

}  // namespace
}  // namespace sfumato::lists::stress
