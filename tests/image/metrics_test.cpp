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

TEST(Compare, RefusesOtherSizes) {
  EXPECT_TRUE(isUsageError([] { compare(Image(2, 1, 1), Image(1, 2, 1)); }));
}

}  // namespace
}  // namespace sfumato::image
