// Deep files, flattened by OpenImageIO, against their samples composited in double precision.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "base/file.h"
#include "base/random.h"
#include "image/image_file.h"
#include "tests/base/temporary_folder.h"
#include "tests/image/deep_compositing.h"
#include "tests/image/openimageio.h"

namespace sfumato::image {
namespace {

namespace fs = std::filesystem;

class DeepFile : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::hasOpenImageIO()) GTEST_SKIP() << "this build has no OpenImageIO";
  }
  fs::path file(const char* name) const { return folder_.path() / name; }

  const test::TemporaryFolder folder_{"deep"};
};

// Up to 40 samples a pixel, of all alphas from 1e-6 to 1, some pixels without any.
DeepImage randomImage(int width, int height, bool coloured) {
  base::Random random(coloured ? 3 : 2);
  DeepImage image(width, height);
  for (auto& samples : image.pixels) {
    const auto count = static_cast<int>(random.uniform(0, 41));
    float depth = 1;
    for (int i = 0; i < count; ++i) {
      DeepSample sample;
      sample.z = depth;
      depth += random.uniform() < 0.3 ? 0.f : static_cast<float>(random.uniform());
      sample.zBack = depth;
      const auto anyAlpha = [&] {
        const double exponent = random.uniform(-6, 0.3);
        return static_cast<float>(std::min(1.0, std::pow(10.0, exponent)));
      };
      const float alpha = anyAlpha();
      sample.takes = {alpha, alpha, alpha};
      sample.alpha = alpha;
      if (coloured) sample.takes = {anyAlpha(), alpha, anyAlpha()};
      for (float& colour : sample.colour)
        colour = sample.alpha * static_cast<float>(std::pow(10.0, random.uniform(-2, 2)));
      samples.push_back(sample);
    }
  }
  return image;
}

// What a half may be off by, relative; below their normal range absolute.
constexpr double halfError = 0x1p-11;
constexpr double smallestHalf = 0x1p-24;

// Each sample's colour is rounded to a half, so their sum is off by as much, and more where they are many and
// as small as halves are.
void expectFlattens(const fs::path& path, const DeepImage& image) {
  const Image flat = readImage(path);
  ASSERT_EQ(flat.width, image.width);
  ASSERT_EQ(flat.height, image.height);
  ASSERT_EQ(flat.channels, 3);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const auto& samples = image.pixel(x, y);
      const test::Composite truth = test::composite(samples);
      for (int c = 0; c < 3; ++c) {
        const double tolerance =
            halfError * truth.colour[c] + smallestHalf * static_cast<double>(samples.size() + 1);
        ASSERT_NEAR(flat.pixel(x, y)[c], truth.colour[c], tolerance) << x << " " << y << " " << c;
      }
    }
}

TEST_F(DeepFile, FlattensToItsSamples) {
  for (const bool coloured : {false, true}) {
    const DeepImage image = randomImage(37, 70, coloured);
    writeDeep(file("a.exr"), {&image, 1}, {{"Software", "test"}});
    expectFlattens(file("a.exr"), image);
  }
}

TEST_F(DeepFile, OfOtherSamplesWouldNotPass) {
  DeepImage image = randomImage(8, 8, false);
  writeDeep(file("a.exr"), {&image, 1}, {});
  const Image flat = readImage(file("a.exr"));
  double off = 0;
  for (auto& samples : image.pixels)
    for (DeepSample& sample : samples) sample.alpha *= 0.99f;
  for (int i = 0; i < 64; ++i) {
    const auto truth = test::composite(image.pixels[static_cast<size_t>(i)]);
    if (truth.colour.x > 0)
      off = std::max(off, std::abs(flat.values[static_cast<size_t>(3 * i)] / truth.colour.x - 1));
  }
  EXPECT_GT(off, 10 * halfError);
}

TEST_F(DeepFile, WhatRoundsToOpaqueHidesNothing) {
  DeepImage image(1, 1);
  const DeepSample almost{1, 2, {0, 0, 0}, 0.9999f, {0.9999f, 0.9999f, 0.9999f}};
  const DeepSample bright{3, 3, {10000, 10000, 10000}, 1, {1, 1, 1}};
  image.pixels[0] = {almost, bright};
  writeDeep(file("a.exr"), {&image, 1}, {});
  EXPECT_NEAR(readImage(file("a.exr")).values[0], 1, 1e-3);
}

TEST_F(DeepFile, TheSameImageMakesTheSameBytes) {
  const DeepImage image = randomImage(5, 5, true);
  for (const char* name : {"a.exr", "b.exr"}) writeDeep(file(name), {&image, 1}, {{"key", "value"}});
  EXPECT_EQ(base::readFile(file("a.exr")), base::readFile(file("b.exr")));
}

TEST_F(DeepFile, SeveralPartsAreOneFile) {
  std::vector<DeepImage> parts = {randomImage(8, 8, false), randomImage(8, 8, true)};
  parts[0].name = "+x";
  parts[1].name = "-x";
  writeDeep(file("a.exr"), parts, {});
  expectFlattens(file("a.exr"), parts[0]);  // the first is what is read
}

TEST_F(DeepFile, AnImageOfNothingIsWritten) {
  const DeepImage image(3, 2);
  writeDeep(file("a.exr"), {&image, 1}, {});
  const Image flat = readImage(file("a.exr"));
  EXPECT_EQ(flat.values, std::vector<float>(18, 0.f));
}

template <typename Body>
base::ExitCode codeOf(Body body) {
  try {
    body();
  } catch (const base::Error& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    return error.exitCode;
  }
  return base::ExitCode::Done;
}

TEST_F(DeepFile, WhatCannotBeWrittenLeavesNothing) {
  const DeepImage image = randomImage(5, 5, false);
  const auto write = [&](const fs::path& path) { return codeOf([&] { writeDeep(path, {&image, 1}, {}); }); };
  EXPECT_EQ(write(file("a.png")), base::ExitCode::Usage);
  EXPECT_EQ(write(file("missing/a.exr")), base::ExitCode::Input);
  fs::create_directory(file("folder.exr"));
  EXPECT_EQ(write(file("folder.exr")), base::ExitCode::Input);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()), 1);
}

TEST_F(DeepFile, DamagedFilesAreRefused) {
  const DeepImage image = randomImage(64, 64, false);
  writeDeep(file("a.exr"), {&image, 1}, {});
  const auto bytes = base::readFile(file("a.exr"));
  const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  for (const double part : {0.999, 0.9, 0.5, 0.1, 0.01}) {
    base::writeFile(file("cut.exr"),
                    text.substr(0, static_cast<size_t>(part * static_cast<double>(text.size()))));
    EXPECT_EQ(codeOf([&] { readImage(file("cut.exr")); }), base::ExitCode::Input) << part;
  }
  base::Random random(5);
  for (int i = 0; i < 50; ++i) {  // any answer but a crash
    std::string bent = text;
    for (int k = 0; k < 4; ++k)
      bent[static_cast<size_t>(random.uniform() * static_cast<double>(bent.size()))] ^= 0x55;
    base::writeFile(file("bent.exr"), bent);
    codeOf([&] { readImage(file("bent.exr")); });
  }
}

}  // namespace
}  // namespace sfumato::image
