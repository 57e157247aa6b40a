#include "image/metrics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"

namespace sfumato::image {
namespace {

Image make(int width, int height, int channels, std::vector<float> values) {
  Image image(width, height, channels);
  image.values = std::move(values);
  return image;
}

template <typename Body>
bool isUsageError(Body body) {
  try {
    body();
  } catch (const base::Error& error) {
    return error.exitCode == base::ExitCode::Usage;
  }
  return false;
}

TEST(AverageDown, MeansOfBlocks) {
  const Image image = make(4, 2, 1, {1, 2, 3, 4, 5, 6, 7, 9});
  const Image small = averageDown(image, 2);
  EXPECT_EQ(small.width, 2);
  EXPECT_EQ(small.height, 1);
  EXPECT_EQ(small.values, (std::vector<float>{3.5f, 5.75f}));
  EXPECT_EQ(averageDown(image, 1).values, image.values);
}

TEST(AverageDown, ChannelsStayApart) {
  EXPECT_EQ(averageDown(make(2, 2, 2, {1, 10, 2, 20, 3, 30, 4, 40}), 2).values,
            (std::vector<float>{2.5f, 25.f}));
}

TEST(AverageDown, RefusesFactorsThatDoNotDivide) {
  const Image image(4, 6, 1);
  EXPECT_TRUE(isUsageError([&] { averageDown(image, 4); }));
  EXPECT_TRUE(isUsageError([&] { averageDown(image, 3); }));
  EXPECT_TRUE(isUsageError([&] { averageDown(image, 0); }));
  EXPECT_TRUE(isUsageError([&] { averageDown(image, -2); }));
  EXPECT_FALSE(isUsageError([&] { averageDown(image, 2); }));
}

TEST(Compare, KnownFigures) {
  const Difference difference = compare(make(2, 1, 1, {1, 6}), make(2, 1, 1, {1, 2}));
  EXPECT_DOUBLE_EQ(difference.rmse, std::sqrt(8.));
  EXPECT_DOUBLE_EQ(difference.relativeRmse, std::sqrt(8.) / 1.5);
  EXPECT_DOUBLE_EQ(difference.maximum, 4);
  EXPECT_DOUBLE_EQ(difference.meanRatio, 3.5 / 1.5);
}

TEST(Compare, OnlyTheChannelsThatBothHave) {
  const Difference difference = compare(make(1, 1, 4, {1, 2, 3, 99}), make(1, 1, 3, {1, 2, 3}));
  EXPECT_EQ(difference.rmse, 0);
  EXPECT_EQ(difference.meanRatio, 1);
}

TEST(Compare, BlackImages) {
  const Difference same = compare(Image(2, 2, 3), Image(2, 2, 3));
  EXPECT_EQ(same.relativeRmse, 0);
  EXPECT_EQ(same.meanRatio, 1);
  EXPECT_TRUE(std::isinf(compare(make(1, 1, 1, {1}), make(1, 1, 1, {0})).relativeRmse));
}

TEST(Compare, ANanAnywhereShowsInEveryFigure) {
  const float nan = std::nanf("");
  const std::vector<float> clean = {1, 2, 3};
  for (size_t at = 0; at < 3; ++at) {
    std::vector<float> dirty = clean;
    dirty[at] = nan;
    for (const bool inReference : {false, true}) {
      const Difference d = inReference ? compare(make(3, 1, 1, clean), make(3, 1, 1, dirty))
                                       : compare(make(3, 1, 1, dirty), make(3, 1, 1, clean));
      for (double figure : {d.rmse, d.relativeRmse, d.maximum, d.meanRatio}) EXPECT_TRUE(std::isnan(figure));
    }
  }
}

TEST(Compare, SaysWhereTheMaximumIs) {
  const Difference d = compare(make(2, 2, 2, {0, 0, 0, 0, 0, -3, 0, 3}), Image(2, 2, 2));
  EXPECT_EQ(d.maximum, 3);
  EXPECT_EQ(d.maximumAt.x, 0);
  EXPECT_EQ(d.maximumAt.y, 1);
  EXPECT_EQ(d.maximumAt.channel, 1);
}

TEST(Compare, PsnrIsOfTheLargestValue) {
  EXPECT_NEAR(compare(make(1, 1, 1, {0.5f}), make(1, 1, 1, {0.4f})).psnr, 20, 1e-5);  // of 1
  EXPECT_NEAR(compare(make(1, 1, 1, {10}), make(1, 1, 1, {9})).psnr, 20, 1e-9);
  EXPECT_NEAR(compare(make(1, 1, 1, {9}), make(1, 1, 1, {10})).psnr, 20, 1e-9);
  EXPECT_EQ(compare(make(1, 1, 1, {2}), make(1, 1, 1, {2})).psnr, INFINITY);
}

TEST(PixelsBeyond, CountsPixelsAndNotChannels) {
  const Image image = make(3, 1, 2, {0, 0, 2, 2, 0, 1});
  EXPECT_EQ(pixelsBeyond(image, Image(3, 1, 2), 0), 2u);
  EXPECT_EQ(pixelsBeyond(image, Image(3, 1, 2), 1), 1u);
  EXPECT_EQ(pixelsBeyond(image, Image(3, 1, 2), 2), 0u);
  EXPECT_EQ(pixelsBeyond(image, Image(3, 1, 1), 0), 1u);
  EXPECT_EQ(pixelsBeyond(make(1, 1, 1, {NAN}), Image(1, 1, 1), 1e9), 1u);
  EXPECT_TRUE(isUsageError([] { pixelsBeyond(Image(2, 1, 1), Image(1, 2, 1), 0); }));
  EXPECT_TRUE(isUsageError([] { pixelsBeyond(Image(), Image(), 0); }));
}

TEST(FindNotFinite, FindsTheFirst) {
  EXPECT_EQ(findNotFinite(make(2, 1, 1, {-1, 65504})).count, 0u);
  const NotFinite found = findNotFinite(make(2, 2, 2, {0, 0, 0, 0, 0, -INFINITY, NAN, 0}));
  EXPECT_EQ(found.count, 2u);
  EXPECT_EQ(found.value, -INFINITY);
  EXPECT_EQ(found.first.x, 0);
  EXPECT_EQ(found.first.y, 1);
  EXPECT_EQ(found.first.channel, 1);
}

TEST(Compare, RefusesOtherSizes) {
  EXPECT_TRUE(isUsageError([] { compare(Image(2, 1, 1), Image(1, 2, 1)); }));
}

}  // namespace
}  // namespace sfumato::image
