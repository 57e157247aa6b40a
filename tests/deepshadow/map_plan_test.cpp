// What is given up for the memory of deep shadow maps, and in which order.
#include "deepshadow/map_plan.h"

#include <gtest/gtest.h>

namespace sfumato::deepshadow {
namespace {

TEST(MapPlan, ResolutionsGoDownEvenlyByTheRootOfTheExcess) {
  const MapPlan asked{{1024, 512, 0}, 1.0 / 512};
  const auto plan = coarser(asked, asked, {}, 4);
  ASSERT_TRUE(plan);
  EXPECT_EQ(plan->resolutions, (std::vector<int>{512, 256, 0}));
  EXPECT_EQ(plan->error, asked.error);
}

TEST(MapPlan, ComesToAnEndThatGivesUpEverything) {
  const MapPlan asked{{1024, 64}, 1.0 / 512};
  MapPlan plan = asked;
  int steps = 0;
  bool resolutionFirst = true;
  while (const auto next = coarser(plan, asked, {}, 1.05)) {
    resolutionFirst = resolutionFirst && (next->error == asked.error || next->resolutions[0] <= 256);
    plan = *next;
    ASSERT_LT(++steps, 1000);
  }
  EXPECT_TRUE(resolutionFirst);
  EXPECT_EQ(plan.resolutions, (std::vector<int>{32, 32}));
  EXPECT_DOUBLE_EQ(plan.error, 8.0 / 512);
}

TEST(MapPlan, KeepsWhatItMustKeep) {
  const MapPlan asked{{256}, 0};
  MapPlan plan = asked;
  while (const auto next = coarser(plan, asked, {.lowerResolution = false}, 3)) plan = *next;
  EXPECT_EQ(plan.resolutions, asked.resolutions);
  EXPECT_DOUBLE_EQ(plan.error, 8.0 / 4096);
  plan = asked;
  while (const auto next = coarser(plan, asked, {.loosenError = false}, 3)) plan = *next;
  EXPECT_EQ(plan.resolutions[0], 32);
  EXPECT_EQ(plan.error, 0);
  EXPECT_FALSE(coarser(asked, asked, {.lowerResolution = false, .loosenError = false}, 2));
}

TEST(MapPlan, AnyExcessChangesSomething) {
  const MapPlan asked{{1024}, 1.0 / 512};
  EXPECT_LT(coarser(asked, asked, {}, 1.0001)->resolutions[0], 1024);
}

}  // namespace
}  // namespace sfumato::deepshadow
