#include "image/image_file.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>

#include "base/error.h"
#include "base/file.h"
#include "tests/base/temporary_folder.h"
#include "tests/image/openimageio.h"
#include "tests/image/png_builder.h"

namespace sfumato::image {
namespace {

namespace fs = std::filesystem;
using test::PngBuilder;

class ImageFile : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::hasOpenImageIO()) GTEST_SKIP() << "this build has no OpenImageIO";
  }

  fs::path file(const char* name) const { return folder_.path() / name; }

  void writeBytes(const fs::path& path, std::span<const std::byte> bytes) const {
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<long>(bytes.size()));
  }

  size_t filesInFolder() const {
    return static_cast<size_t>(
        std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()));
  }

  const test::TemporaryFolder folder_{"image"};
};

// The exit code of the Error that `body` throws, after a look at its line; 0 when nothing is thrown.
template <typename Body>
int codeOf(Body body, const std::string& lineStart) {
  try {
    body();
  } catch (const base::Error& error) {
    const std::string line = error.what();
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    EXPECT_EQ(line.substr(0, lineStart.size()), lineStart) << line;
    return static_cast<int>(error.exitCode);
  }
  return 0;
}

constexpr int input = static_cast<int>(base::ExitCode::Input);
constexpr int usage = static_cast<int>(base::ExitCode::Usage);

Image ramp(int width, int height, int channels) {
  Image image(width, height, channels);
  for (size_t i = 0; i < image.values.size(); ++i) image.values[i] = static_cast<float>(i) / 64.f - 1.f;
  return image;
}

TEST_F(ImageFile, HalfExrKeepsValuesThatHalfHolds) {
  for (int channels : {3, 4}) {
    const Image image = ramp(5, 3, channels);  // multiples of 1/64 below 2: exact in half
    writeImage(file("a.exr"), image, {});
    const Image back = readImage(file("a.exr"));
    EXPECT_EQ(back.width, 5);
    EXPECT_EQ(back.height, 3);
    EXPECT_EQ(back.channels, channels);
    EXPECT_EQ(back.values, image.values);
  }
}

TEST_F(ImageFile, HalfExrClampsAndKeepsNan) {
  Image image(2, 1, 3);
  const float inf = std::numeric_limits<float>::infinity();
  image.values = {1e6f, -1e6f, std::nanf(""), inf, 65504.f, 0.1f};
  writeImage(file("a.exr"), image, {});
  const Image back = readImage(file("a.exr"));
  EXPECT_EQ(back.values[0], 65504.f);
  EXPECT_EQ(back.values[1], -65504.f);
  EXPECT_TRUE(std::isnan(back.values[2]));
  EXPECT_EQ(back.values[3], 65504.f);
  EXPECT_EQ(back.values[4], 65504.f);
  EXPECT_NEAR(back.values[5], 0.1f, 0.1f / 2048);  // half has 11 bits
  EXPECT_NE(back.values[5], 0.1f);
}

TEST_F(ImageFile, FullFloatExrIsExact) {
  Image image(2, 1, 3);
  image.values = {1e6f, -1e-30f, 0.1f, 3e38f, std::numeric_limits<float>::infinity(), 0.f};
  writeImage(file("a.exr"), image, {}, true);
  EXPECT_EQ(readImage(file("a.exr")).values, image.values);
}

TEST_F(ImageFile, LayersStandBesideThePicture) {
  // More rows than are converted at a time, values that half would round, and one that it cannot hold.
  const Image picture = ramp(5, 150, 3);
  Layer depth{"depth", {"Z"}, ramp(5, 150, 1)};
  depth.image.pixel(4, 149)[0] = std::numeric_limits<float>::infinity();
  depth.image.pixel(3, 149)[0] = 1.0001f;
  Layer normal{"normal", {"X", "Y", "Z"}, ramp(5, 150, 3)};
  normal.image.pixel(2, 70)[1] = -0.70710678f;
  const Layer count{"shadow_nodes", {"Y"}, ramp(5, 150, 1)};
  const std::array layers = {normal, depth, count};
  writeLayers(file("a.exr"), picture, layers, {});
  EXPECT_EQ(readImage(file("a.exr")).channels, 3);
  writeImage(file("b.exr"), picture, {});
  EXPECT_EQ(readImage(file("a.exr")).values, readImage(file("b.exr")).values);
  for (const Layer& layer : layers) {
    const Layer read = readLayer(file("a.exr"), layer.name);
    EXPECT_EQ(read.channels, layer.channels);
    EXPECT_EQ(read.image.values, layer.image.values);
  }
  EXPECT_EQ(codeOf([&] { readLayer(file("a.exr"), "dep"); }, file("a.exr").string() + ": has no layer"),
            input);
  EXPECT_TRUE(holdsLayers("a.EXR"));
  EXPECT_FALSE(holdsLayers("a.png"));
}

TEST_F(ImageFile, PicturesOfManyRowsAreWhole) {
  Image tall(3, 200, 3);
  for (int y = 0; y < 200; ++y) tall.pixel(1, y)[1] = static_cast<float>(y) / 400;
  writeImage(file("a.png"), tall, {});
  const Image read = readImage(file("a.png"));
  for (int y = 1; y < 200; ++y) EXPECT_GE(read.pixel(1, y)[1], read.pixel(1, y - 1)[1]) << y;
  EXPECT_GT(read.pixel(1, 199)[1], 0.7f);
  EXPECT_LT(read.pixel(1, 60)[1], 0.5f);
}

TEST_F(ImageFile, ExrHeaderHoldsZipAndMetadata) {
  writeImage(file("a.exr"), ramp(2, 2, 3), {{"sfumato:scene", "two words"}});
  const auto bytes = base::readFile(file("a.exr"));
  const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  EXPECT_NE(text.find(std::string("sfumato:scene\0string\0", 21)), std::string::npos);
  EXPECT_NE(text.find("two words"), std::string::npos);
  const std::string zip("compression\0compression\0\1\0\0\0\3", 29);  // 3: zip, 16 scanlines a block
  EXPECT_NE(text.find(zip), std::string::npos);
}

TEST_F(ImageFile, PngIsToneMappedSrgbWithMetadata) {
  Image image(3, 1, 4);
  const float inf = std::numeric_limits<float>::infinity();
  image.values = {0, 0, 0, 1, 0.54f, 0.54f, 0.54f, 0.5f, inf, inf, inf, 0};
  writeImage(file("a.png"), image, {{"Description", "made by a test"}});
  const Picture picture = decodePicture(base::readFile(file("a.png")), "a.png");
  // 0.54 less the curve's offset 0.04 is 0.5, which sRGB encodes as 188; 0.5 * 255 rounds up to 128.
  const std::vector<uint8_t> expected = {0, 0, 0, 255, 188, 188, 188, 128, 255, 255, 255, 0};
  EXPECT_EQ(picture.rgba, expected);
  const auto bytes = base::readFile(file("a.png"));
  EXPECT_NE(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()).find("made by a test"),
            std::string::npos);
}

TEST_F(ImageFile, RefusesUnknownEndingsAndBadPlaces) {
  const Image image = ramp(2, 2, 3);
  EXPECT_EQ(codeOf([&] { checkImageName("a.jpg"); }, "a.jpg: "), usage);
  EXPECT_EQ(codeOf([&] { checkImageName("exr"); }, "exr: "), usage);
  EXPECT_EQ(codeOf([&] { checkImageName("a.EXR"); }, ""), 0);
  EXPECT_EQ(codeOf([&] { writeImage("a.tiff", image, {}); }, "a.tiff: "), usage);
  const std::string missing = (folder_.path() / "no" / "a.exr").string();
  EXPECT_EQ(codeOf([&] { writeImage(missing, image, {}); }, missing + ": "), input);
  fs::create_directories(file("folder.exr"));
  EXPECT_EQ(codeOf([&] { writeImage(file("folder.exr"), image, {}); }, file("folder.exr").string()), input);
  EXPECT_EQ(filesInFolder(), 1u);  // nothing half-written stays
}

TEST_F(ImageFile, ReadingBadFilesIsAnInputError) {
  const auto fails = [&](const char* name) {
    return codeOf([&] { readImage(file(name)); }, file(name).string() + ": ");
  };
  EXPECT_EQ(fails("missing.exr"), input);
  fs::create_directories(file("folder.exr"));
  EXPECT_EQ(fails("folder.exr"), input);
  writeBytes(file("empty.exr"), {});
  EXPECT_EQ(fails("empty.exr"), input);
  std::ofstream(file("text.exr")) << "not an image at all";
  EXPECT_EQ(fails("text.exr"), input);

  writeImage(file("good.exr"), ramp(64, 64, 3), {});
  const auto bytes = base::readFile(file("good.exr"));
  for (size_t size : {size_t{1}, size_t{4}, size_t{50}, bytes.size() / 2, bytes.size() - 1}) {
    writeBytes(file("cut.exr"), std::span(bytes).first(size));
    EXPECT_EQ(fails("cut.exr"), input) << size;
  }
}

TEST_F(ImageFile, HugeHeaderOfASmallFileIsRefused) {
  writeImage(file("a.exr"), ramp(4, 4, 3), {});
  auto bytes = base::readFile(file("a.exr"));
  const int32_t small[4] = {0, 0, 3, 3}, huge[4] = {0, 0, 19999, 19999};
  int replaced = 0;
  for (size_t i = 0; i + sizeof small <= bytes.size(); ++i)
    if (std::memcmp(&bytes[i], small, sizeof small) == 0) {
      std::memcpy(&bytes[i], huge, sizeof huge);
      ++replaced;
    }
  ASSERT_EQ(replaced, 2);  // data window and display window
  writeBytes(file("huge.exr"), bytes);
  EXPECT_EQ(codeOf([&] { readImage(file("huge.exr")); }, file("huge.exr").string() + ": "), input);
}

class DecodePicture : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::hasOpenImageIO()) GTEST_SKIP() << "this build has no OpenImageIO";
  }
};

struct PngCase {
  const char* name;
  int bitDepth, colourType;
  std::vector<uint8_t> rows;      // two pixels side by side
  std::vector<uint8_t> expected;  // as RGBA
};

TEST_F(DecodePicture, EveryPngLayoutBecomesRgba) {
  const std::vector<uint8_t> palette = {1, 2, 3, 250, 251, 252};
  const PngCase cases[] = {
      {"grey", 8, 0, {7, 200}, {7, 7, 7, 255, 200, 200, 200, 255}},
      {"RGB", 8, 2, {1, 2, 3, 4, 5, 6}, {1, 2, 3, 255, 4, 5, 6, 255}},
      {"palette", 8, 3, {1, 0}, {250, 251, 252, 255, 1, 2, 3, 255}},
      {"grey and alpha", 8, 4, {100, 50, 9, 0}, {100, 100, 100, 50, 9, 9, 9, 0}},
      {"RGBA", 8, 6, {200, 100, 50, 10, 1, 2, 3, 0}, {200, 100, 50, 10, 1, 2, 3, 0}},
      {"16-bit grey", 16, 0, {0x80, 0x80, 0xff, 0xff}, {128, 128, 128, 255, 255, 255, 255, 255}},
      {"16-bit RGBA",
       16,
       6,
       {0x10, 0x10, 0x20, 0x20, 0x30, 0x30, 0x40, 0x40, 0, 0, 0xff, 0xff, 0x01, 0x01, 0xff, 0xff},
       {16, 32, 48, 64, 0, 255, 1, 255}},
  };
  for (const PngCase& c : cases) {
    const PngBuilder png(2, 1, c.bitDepth, c.colourType, c.rows,
                         c.colourType == 3 ? std::span<const uint8_t>(palette) : std::span<const uint8_t>());
    const Picture picture = decodePicture(png.bytes(), c.name);
    EXPECT_EQ(picture.width, 2) << c.name;
    EXPECT_EQ(picture.height, 1) << c.name;
    EXPECT_EQ(picture.rgba, c.expected) << c.name;
  }
}

TEST_F(DecodePicture, RowsComeFromTheTop) {
  const std::vector<uint8_t> rows = {10, 20, 30};
  const Picture picture = decodePicture(PngBuilder(1, 3, 8, 0, rows).bytes(), "column");
  EXPECT_EQ(picture.rgba[0], 10);
  EXPECT_EQ(picture.rgba[4], 20);
  EXPECT_EQ(picture.rgba[8], 30);
}

TEST_F(DecodePicture, JpegOfOneColour) {
  const Picture picture =
      decodePicture(base::readFile(SFUMATO_SOURCE_DIR "/tests/image/corpus/solid.jpg"), "solid.jpg");
  ASSERT_EQ(picture.width, 8);
  ASSERT_EQ(picture.height, 8);
  ASSERT_EQ(picture.rgba.size(), 8u * 8 * 4);
  const int expected[4] = {204, 51, 102, 255};  // 0.8, 0.2, 0.4; JPEG rounds YCbCr, so within 2
  for (size_t i = 0; i < picture.rgba.size(); ++i) EXPECT_NEAR(picture.rgba[i], expected[i % 4], 2);
}

TEST_F(DecodePicture, WhatIsNoPictureIsAnInputError) {
  const auto fails = [](std::span<const std::byte> bytes) {
    return codeOf([&] { decodePicture(bytes, "the name"); }, "the name: ");
  };
  EXPECT_EQ(fails({}), input);
  EXPECT_EQ(fails(std::as_bytes(std::span("GIF89a and more"))), input);
  EXPECT_EQ(fails(std::as_bytes(std::span("\x89PNG\r\n\x1a\n", 8))), input);
  EXPECT_EQ(fails(std::as_bytes(std::span("\xff\xd8\xff\xe0", 4))), input);

  const std::vector<uint8_t> rows(64 * 64, 5);
  const auto good = PngBuilder(64, 64, 8, 0, rows).bytes();
  ASSERT_EQ(fails(good), 0);
  for (size_t size = 0; size < good.size(); size += 7)
    EXPECT_EQ(fails(std::span(good).first(size)), input) << size;

  const auto jpeg = base::readFile(SFUMATO_SOURCE_DIR "/tests/image/corpus/solid.jpg");
  for (size_t size : {size_t{20}, jpeg.size() / 2, jpeg.size() - 10})
    EXPECT_EQ(fails(std::span(jpeg).first(size)), input) << size;

  const std::vector<uint8_t> none;
  EXPECT_EQ(fails(PngBuilder(16385, 1, 8, 0, std::vector<uint8_t>(16385)).bytes()), input);
  EXPECT_EQ(fails(PngBuilder(1, 16385, 8, 0, std::vector<uint8_t>(16385)).bytes()), input);
  // A header that promises a gigabyte, and nothing behind it.
  EXPECT_EQ(fails(PngBuilder(16384, 16384, 8, 6, none).bytes()), input);
}

TEST_F(DecodePicture, DamagedBytesDecodeOrFailInOneLine) {
  const std::vector<uint8_t> rows(16 * 16 * 3, 5);
  const auto png = PngBuilder(16, 16, 8, 2, rows).bytes();
  const auto jpeg = base::readFile(SFUMATO_SOURCE_DIR "/tests/image/corpus/solid.jpg");
  for (const auto& good : {png, jpeg})
    for (size_t at = 0; at < good.size(); ++at) {
      auto damaged = good;
      damaged[at] ^= std::byte{0x55};
      const int code = codeOf([&] { decodePicture(damaged, "damaged"); }, "damaged: ");
      EXPECT_TRUE(code == 0 || code == input) << at;
    }
}

TEST(WithoutOpenImageIO, EveryFunctionSaysSo) {
  if (test::hasOpenImageIO()) GTEST_SKIP() << "this build has OpenImageIO";
  EXPECT_EQ(codeOf([] { readImage("a.exr"); }, "a.exr: "), input);
  EXPECT_EQ(codeOf([] { writeImage("a.exr", Image(1, 1, 3), {}); }, "a.exr: "), input);
  EXPECT_EQ(codeOf([] { checkImageName("a.exr"); }, "a.exr: "), input);
  EXPECT_EQ(codeOf([] { writeLayers("a.exr", Image(1, 1, 3), {}, {}); }, "a.exr: "), input);
  EXPECT_EQ(codeOf([] { holdsLayers("a.exr"); }, "a.exr: "), input);
  EXPECT_EQ(codeOf([] { writeDeep("a.exr", {}, {}); }, "a.exr: "), input);
  EXPECT_EQ(codeOf([] { checkDeepName("a.exr"); }, "a.exr: "), input);
  EXPECT_EQ(codeOf([] { readLayer("a.exr", "depth"); }, "a.exr: "), input);
  EXPECT_EQ(codeOf([] { decodePicture({}, "a picture"); }, "a picture: "), input);
}

}  // namespace
}  // namespace sfumato::image
