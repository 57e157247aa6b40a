// What media do to light, on the GPU against the reference.
#include "tests/pipelines/frame_test.h"
#include "tests/pipelines/media_scenes.h"

namespace sfumato::pipelines {
namespace {

using tests::KnownScene;

constexpr int width = 48;
constexpr int height = 36;

std::vector<KnownScene> mediaScenes() {
  return {tests::colouredSlab(), tests::overlappingColours(), tests::colouredShadow(), tests::colouredBalls(),
          tests::burningSlab(),  tests::fireBehindSmoke(),    tests::burningBall()};
}

class MediaGpuFrames : public FrameTest<width, height> {};

class MediaGpu : public MediaGpuFrames, public testing::WithParamInterface<std::string> {};

TEST_P(MediaGpu, LookLikeTheReference) {
  const KnownScene known = tests::named(mediaScenes(), GetParam());
  const Frame frame = draw(known, fine);
  const image::Image reference = referenceOf(known);
  const PixelErrors found = compareFrames(known.name, frame.radiance, reference);
  // As in linked_lists_gpu_test.cpp.
  EXPECT_LT(found.failingFraction, 0.005);
  EXPECT_NEAR(found.meanRatio, 1.0, 0.001);
  EXPECT_EQ(frame.statistics.cutWalks, 0u);
}

INSTANTIATE_TEST_SUITE_P(Scenes, MediaGpu, testing::ValuesIn(tests::namesOf(mediaScenes())),
                         [](const auto& info) { return tests::testName(info.param); });

// The comparison would see a colour that is lost.
TEST_F(MediaGpuFrames, AGreyMediumInPlaceOfAColouredOneIsSeen) {
  KnownScene known = tests::colouredBalls();
  const image::Image reference = referenceOf(known);
  for (volumes::Medium& medium : known.media) medium.extinctionColour = glm::dvec3(0.5);
  EXPECT_GT(errors(draw(known, fine).radiance, reference).failingFraction, 0.1);
}

// A colour of equal parts is a scale: the same shaders, the same bits.
TEST_F(MediaGpuFrames, AGreyColourIsAScale) {
  KnownScene known = tests::colouredBalls();
  for (volumes::Medium& medium : known.media) medium.extinctionColour = glm::dvec3(0.5);
  const Frame coloured = draw(known, fine);
  for (volumes::Medium& medium : known.media) {
    medium.extinctionColour = glm::dvec3(1);
    medium.scale *= 0.5;
  }
  EXPECT_EQ(coloured.radiance.values, draw(known, fine).radiance.values);
}

TEST_F(MediaGpuFrames, AFireThatIsOutIsSeen) {
  KnownScene known = tests::burningBall();
  const image::Image reference = referenceOf(known);
  known.media[0].fire.reset();
  // Twice what LookLikeTheReference lets through.
  EXPECT_GT(errors(draw(known, fine).radiance, reference).failingFraction, 0.01);
}

TEST_F(MediaGpuFrames, MultipleScatteringIsThatOfTheReference) {
  const KnownScene known = tests::colouredBalls();
  Quality quality = fine;
  quality.scatteringOctaves = 3;
  const image::Image reference = referenceOf(known, {.scatteringOctaves = 3});
  const PixelErrors found = compareFrames("multiple scattering", draw(known, quality).radiance, reference);
  EXPECT_LT(found.failingFraction, 0.005);
  EXPECT_NEAR(found.meanRatio, 1.0, 0.001);
  quality.scatteringOctaves = 0;
  EXPECT_GT(errors(draw(known, quality).radiance, reference).failingFraction, 0.02) << "single scattering";
}

TEST_F(MediaGpuFrames, AFurnaceGetsNoBrighterThanItsWalls) {
  const KnownScene known = tests::furnace(32);
  LinkedListsPipeline pipeline(device(), known.scene, known.media);
  Quality quality = qualityNamed("medium");
  quality.shadowResolution = 64;
  quality.scatteringOctaves = maxScatteringOctaves;
  const Frame frame =
      pipeline.render(known.scene.cameras[0], 32, 32, quality, {.aovs = {Aov::Transmittance}});
  const std::vector<float>& behind = frame.aovs.at(Aov::Transmittance).values;
  for (size_t i = 0; i < behind.size(); ++i) ASSERT_LE(frame.radiance.values[i] + behind[i], 1.001f) << i;
  const size_t middle = 3 * (16 * 32 + 16);
  EXPECT_GT(frame.radiance.values[middle] + behind[middle], 0.5f);
}

}  // namespace
}  // namespace sfumato::pipelines
