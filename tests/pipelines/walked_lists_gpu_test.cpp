// What the core pipeline is measured against draws the same: lists that stay linked, as Lindbeck 2015 has
// them.
#include <gtest/gtest.h>

#include "image/metrics.h"
#include "tests/pipelines/frame_test.h"

namespace sfumato::pipelines {
namespace {

class WalkedListsGpu : public FrameTest<96, 72> {
 protected:
  Frame draw(const tests::KnownScene& known, int smokeNodes) {
    Quality quality = fine;
    quality.shadowResolution = 256;
    quality.walkedSmokeNodes = smokeNodes;
    if (smokeNodes > 0) quality.lists.strategy = lists::Strategy::SpinLock;
    return FrameTest::draw(known, quality);
  }
};

TEST_F(WalkedListsGpu, DrawTheSameOfEveryKnownScene) {
  for (const tests::KnownScene& known : tests::knownScenes()) {
    const Frame runs = draw(known, 0);
    const Frame walked = draw(known, 32);
    const PixelErrors found = compareFrames(known.name, walked.radiance, runs.radiance);
    EXPECT_LT(found.failingFraction, 0.002) << known.name;
    EXPECT_NEAR(found.meanRatio, 1.0, 0.002) << known.name;
    EXPECT_EQ(walked.statistics.lights.stored, runs.statistics.lights.stored) << known.name;
  }
}

// One node for all of a ray's smoke is the thesis's, and wrong: what 32 are compared with would show it.
TEST_F(WalkedListsGpu, OneNodeOfSmokeIsNotEnough) {
  const tests::KnownScene known = tests::smokeAndGlass();
  const image::Image runs = draw(known, 0).radiance;
  const double one = image::compare(draw(known, 1).radiance, runs).relativeRmse;
  const double many = image::compare(draw(known, 32).radiance, runs).relativeRmse;
  EXPECT_GT(one, 2 * many);
}

}  // namespace
}  // namespace sfumato::pipelines
