// `sfumato compare`, as a shell runs it.
#include <gtest/gtest.h>

#include <cmath>

#include "image/image_file.h"
#include "tests/app/program.h"
#include "tests/image/openimageio.h"

namespace sfumato::test {
namespace {

// A picture with structure, all of whose values a half holds exactly.
image::Image pattern(int width, int height) {
  image::Image image(width, height, 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c)
        image.pixel(x, y)[c] = 0.25f + 0.125f * static_cast<float>((x + y * 3 + c) % 4);
  return image;
}

class CompareCommand : public testing::Test {
 protected:
  void SetUp() override {
    if (!hasOpenImageIO()) GTEST_SKIP() << "built without OpenImageIO";
    write("a.exr", pattern(8, 6));
    image::Image changed = pattern(8, 6);
    changed.pixel(5, 2)[1] += 0.5f;
    write("b.exr", changed);
  }
  void write(const std::string& name, const image::Image& image) const {
    image::writeImage(folder.path() / name, image, {}, true);
  }
  Outcome compare(Arguments arguments) const {
    arguments.insert(arguments.begin(), "compare");
    return runProgram(folder.path(), arguments);
  }
  Json figures(Arguments arguments, int exitCode) const {
    arguments.push_back("--json");
    const Outcome outcome = compare(arguments);
    EXPECT_EQ(outcome.exitCode, exitCode) << outcome.err;
    return Json::parse(outcome.out);
  }
  // The arguments give this exit code, and this word stands in what is said on stderr (nothing: none).
  void expectVerdict(const Arguments& arguments, int exitCode, const std::string& says) const {
    const Outcome outcome = compare(arguments);
    EXPECT_EQ(outcome.exitCode, exitCode) << outcome.err;
    EXPECT_EQ(outcome.err.empty(), says.empty()) << outcome.err;
    EXPECT_NE(outcome.err.find(says), std::string::npos) << outcome.err;
  }

  TemporaryFolder folder{"compare"};
};

TEST_F(CompareCommand, EqualImagesPass) {
  const Outcome outcome = compare({"a.exr", "a.exr"});
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_EQ(outcome.err, "");
  EXPECT_NE(outcome.out.find("RMSE                 0\n"), std::string::npos) << outcome.out;
  const Json json = figures({"a.exr", "a.exr"}, 0);
  EXPECT_EQ(json["rmse"], 0);
  EXPECT_EQ(json["maximum"], 0);
  EXPECT_EQ(json["mean_ratio"], 1);
  EXPECT_EQ(json["failing_pixels"], 0);
  EXPECT_EQ(json["perceptual_failures"], 0);
  EXPECT_EQ(json["verdict"], "pass");
}

TEST_F(CompareCommand, KnownFigures) {
  const Json json = figures({"b.exr", "a.exr"}, 1);
  double mean = 0;
  for (const float value : pattern(8, 6).values) mean += value / 144.0;
  EXPECT_NEAR(json["rmse"], 0.5 / 12, 1e-9);
  EXPECT_NEAR(json["relative_rmse"], 0.5 / 12 / mean, 1e-9);
  EXPECT_NEAR(json["mean_ratio"], 1 + 0.5 / 144 / mean, 1e-9);
  EXPECT_NEAR(json["maximum"], 0.5, 1e-9);
  EXPECT_EQ(json["maximum_at"], (Json{{"x", 5}, {"y", 2}, {"channel", 1}}));
  EXPECT_EQ(json["failing_pixels"], 1);
  EXPECT_EQ(json["pixels"], 48);
  EXPECT_EQ(json["verdict"], "fail");
}

TEST_F(CompareCommand, FailsWarnsAndPassesAsIdiffDoes) {
  const std::string failure = "sfumato: error: b.exr: 1 of 48 pixels (2.083 %) differ by more than ";
  const std::string warning = "sfumato: warning: b.exr: ";
  expectVerdict({"b.exr", "a.exr"}, 1, failure + "1e-06");
  expectVerdict({"b.exr", "a.exr", "--fail", "0.4"}, 1, failure + "0.4");
  expectVerdict({"b.exr", "a.exr", "--fail", "0.6"}, 0, warning + "1 of 48");
  expectVerdict({"b.exr", "a.exr", "--fail", "0.6", "--warn", "0.6"}, 0, "");
  expectVerdict({"b.exr", "a.exr", "--failpercent", "2"}, 1, failure);
  expectVerdict({"b.exr", "a.exr", "--failpercent", "2.1"}, 0, warning);
  expectVerdict({"b.exr", "a.exr", "--failpercent", "2.1", "--warnpercent", "2.1"}, 0, "");
  expectVerdict({"b.exr", "a.exr", "--failpercent", "2.1", "--hardfail", "0.4"}, 1,
                "sfumato: error: b.exr: a pixel differs by 0.5, more than 0.4");
  expectVerdict({"b.exr", "a.exr", "--failpercent", "2.1", "--hardfail", "0.6"}, 0, warning);
  expectVerdict({"b.exr", "a.exr", "--fail", "1", "--warn", "1", "--hardwarn", "0.4"}, 0,
                warning + "a pixel differs by 0.5, more than 0.4");
  EXPECT_EQ(figures({"b.exr", "a.exr", "--fail", "0.6"}, 0)["verdict"], "warning");
}

TEST_F(CompareCommand, QuietSaysOnlyWhatIsWrong) {
  const Outcome good = compare({"a.exr", "a.exr", "-q"});
  EXPECT_EQ(good.exitCode, 0);
  EXPECT_EQ(good.out + good.err, "");
  expectError(compare({"b.exr", "a.exr", "-q"}), 1, "1 of 48 pixels");
}

TEST_F(CompareCommand, AveragesALargerImageDown) {
  image::Image large(24, 18, 3);
  for (int y = 0; y < 18; ++y)
    for (int x = 0; x < 24; ++x)
      for (int c = 0; c < 3; ++c)  // the middle of each block balances the rest
        large.pixel(x, y)[c] =
            pattern(8, 6).pixel(x / 3, y / 3)[c] + (x % 3 == 1 && y % 3 == 1 ? 1.f : -0.125f);
  write("large.exr", large);
  const Outcome outcome = compare({"large.exr", "a.exr", "--fail", "1e-5", "--warn", "1e-5"});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("large.exr: averaged down, 3 x 3 pixels to one\n"), std::string::npos);
  EXPECT_EQ(figures({"large.exr", "a.exr", "--fail", "1e-5"}, 0)["averaged"], 3);
}

TEST_F(CompareCommand, RefusesOtherSizes) {
  write("wide.exr", pattern(16, 6));
  write("odd.exr", pattern(12, 9));
  const auto before = listing(folder.path());
  for (const char* name : {"wide.exr", "odd.exr"})
    expectError(compare({name, "a.exr", "--heat-map", "heat.png"}), 2, "are no whole multiple of the 8 x 6");
  expectError(compare({"a.exr", "wide.exr"}), 2, "are no whole multiple of the 16 x 6");
  EXPECT_EQ(listing(folder.path()), before);
}

TEST_F(CompareCommand, NamesWhatIsNotFinite) {
  image::Image bad = pattern(8, 6);
  bad.pixel(3, 4)[2] = NAN;
  write("nan.exr", bad);
  bad.pixel(3, 4)[2] = 0;
  bad.pixel(7, 5)[0] = INFINITY;
  write("infinite.exr", bad);
  expectError(compare({"nan.exr", "a.exr"}), 1, "nan.exr: NaN at (3, 4) blue");
  expectError(compare({"a.exr", "nan.exr"}), 1, "nan.exr: NaN at (3, 4) blue");
  expectError(compare({"nan.exr", "nan.exr", "--failpercent", "100"}), 1, "nan.exr: NaN at (3, 4) blue");
  expectError(compare({"a.exr", "infinite.exr"}), 1, "infinite.exr: infinity at (7, 5) red");
}

TEST_F(CompareCommand, SeesWhatAViewerSees) {
  image::Image grey(64, 64, 3);
  std::fill(grey.values.begin(), grey.values.end(), 0.2f);
  image::Image red = grey;
  image::Image dim = grey;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      for (int c = 0; c < 3; ++c) {
        red.pixel(x, y)[c] = c == 0 ? 0.6f : 0.05f;
        dim.pixel(x, y)[c] += (x / 4 + y / 4) % 2 == 0 ? 1e-5f : -1e-5f;
      }
  write("grey.exr", grey);
  write("red.exr", red);
  write("dim.exr", dim);
  EXPECT_GT(figures({"red.exr", "grey.exr"}, 1)["perceptual_failures"], 64 * 64 / 2);
  const Json json = figures({"dim.exr", "grey.exr"}, 1);
  EXPECT_EQ(json["perceptual_failures"], 0);
  EXPECT_EQ(json["failing_pixels"], 64 * 64);
}

TEST_F(CompareCommand, WritesAHeatMap) {
  EXPECT_EQ(compare({"b.exr", "a.exr", "--heat-map", "heat.png"}).exitCode, 1);
  const image::Image heat = image::readImage(folder.path() / "heat.png");
  ASSERT_EQ(heat.width, 8);
  ASSERT_EQ(heat.height, 6);
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 8; ++x) EXPECT_EQ(heat.pixel(x, y)[0] > 0.5f, x == 5 && y == 2) << x << " " << y;
  EXPECT_NE(contentOf(folder.path() / "heat.png").find("0 to 0.5"), std::string::npos);
}

TEST_F(CompareCommand, ReadsOneChannelAndSaysWhenTheyDiffer) {
  image::Image withAlpha(8, 6, 4);
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 8; ++x) std::copy_n(pattern(8, 6).pixel(x, y), 3, withAlpha.pixel(x, y));
  write("alpha.exr", withAlpha);
  expectVerdict({"alpha.exr", "a.exr"}, 0, "sfumato: warning: alpha.exr: 4 channels against the 3 of a.exr");
}

TEST_F(CompareCommand, NamesWhatIsWrong) {
  folder.write("garbage.exr", "This is no picture.");
  folder.write("cut.exr", contentOf(folder.path() / "a.exr").substr(0, 400));
  folder.write("empty.exr", "");
  std::filesystem::create_directory(folder.path() / "folder.png");
  expectErrors(
      folder.path(),
      {
          {{"compare"}, 2, "A is required"},
          {{"compare", "a.exr"}, 2, "B is required"},
          {{"compare", "a.exr", "a.exr", "a.exr"}, 2, "is one argument too many"},
          {{"compare", "a.exr", "a.exr", "--fail", "-1"}, 2, "--fail: \"-1\" is not a number"},
          {{"compare", "a.exr", "a.exr", "--fail", "nan"}, 2, "--fail: \"nan\" is not a number"},
          {{"compare", "a.exr", "a.exr", "--failpercent", "101"},
           2,
           "--failpercent: \"101\" is not a number"},
          {{"compare", "a.exr", "a.exr", "--heat-map", "heat.jpg"}, 2, "heat.jpg: unknown image ending"},
          {{"compare", "a.exr", "a.exr", "--heat-map", "heat.exr"},
           2,
           "heat.exr: is not the name of a picture"},
          {{"compare", "a.exr", "a.exr", "--heat-map", "folder.png"}, 3, "folder.png: is a folder"},
          {{"compare", "a.exr", "a.exr", "--heat-map", "no/heat.png"}, 3, "no/heat.png: cannot be written"},
          {{"compare", "missing.exr", "a.exr"}, 3, "missing.exr: cannot be read"},
          {{"compare", "a.exr", "missing.exr"}, 3, "missing.exr: cannot be read"},
          {{"compare", "garbage.exr", "a.exr"}, 3, "garbage.exr: cannot be read"},
          {{"compare", "cut.exr", "a.exr"}, 3, "cut.exr: "},
          {{"compare", "empty.exr", "a.exr"}, 3, "empty.exr: is empty"},
      });
}

}  // namespace
}  // namespace sfumato::test
