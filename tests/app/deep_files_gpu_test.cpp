// --deep and --deep-shadow as a user meets them: what is refused, what is written, and what oiiotool makes of
// it.
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <set>

#include "base/error.h"
#include "image/image_file.h"
#include "tests/app/program.h"
#include "tests/gl/test_device.h"
#include "volumes/vdb_file.h"

namespace sfumato::test {
namespace {

// A mesh of one square in the plane z, of half the side `half`, that glows.
void addSquare(GltfBuilder& gltf, float half, float z, const std::vector<float>& radiance) {
  const int position =
      gltf.accessor<float>("VEC3", {-half, -half, z, half, -half, z, half, half, z, -half, half, z});
  const int indices = gltf.accessor<uint16_t>("SCALAR", {0, 1, 2, 0, 2, 3});
  const int material = gltf.add("materials", {{"emissiveFactor", radiance},
                                              {"doubleSided", true},
                                              {"pbrMetallicRoughness", {{"baseColorFactor", {0, 0, 0, 1}}}}});
  gltf.meshNode({{"attributes", {{"POSITION", position}}}, {"indices", indices}, {"material", material}});
}

// Looks along -z from z = 5 under a sun that shines along -y, "sun", and a lamp, "lamp".
GltfBuilder emptyScene() {
  GltfBuilder gltf;
  gltf.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}});
  gltf.add("nodes", {{"camera", 0}, {"translation", {0, 0, 5}}});
  gltf.light({{"type", "directional"}, {"intensity", 3}, {"name", "sun"}})["rotation"] = {-0.70710678, 0, 0,
                                                                                          0.70710678};
  gltf.light({{"type", "point"}, {"intensity", 0.001}, {"range", 2}, {"name", "lamp"}})["translation"] = {
      1.2, 0.5, 0.5};
  return gltf;
}

constexpr float cardZ = 0.15f;

std::string sceneText(bool wall, bool smoke, bool card) {
  GltfBuilder gltf = emptyScene();
  if (wall) addSquare(gltf, 4, -2, {0.3f, 0.2f, 0.1f});
  if (card) addSquare(gltf, 0.5f, cardZ, {1, 0.8f, 0.6f});
  if (smoke) gltf.add("nodes", {{"extras", {{"volume", "ball.vdb"}, {"scale", 1.0}}}});
  return gltf.text();
}

// A ball of 1 m that thins out, about the origin.
volumes::DensityGrid ball() {
  volumes::DensityGrid grid;
  grid.name = "density";
  grid.size = glm::ivec3(34);
  grid.values.assign(34 * 34 * 34, 0.f);
  for (int z = 0; z < 34; ++z)
    for (int y = 0; y < 34; ++y)
      for (int x = 0; x < 34; ++x) {
        const double r = glm::length((glm::dvec3(x, y, z) - 16.5) / 16.0);
        grid.values[grid.valueIndex(x, y, z)] = static_cast<float>(5 * std::max(0.0, 1 - r * r));
      }
  for (int axis = 0; axis < 3; ++axis) grid.worldFromIndex[axis][axis] = 1.0 / 16;
  grid.worldFromIndex[3] = {-16.5 / 16, -16.5 / 16, -16.5 / 16, 1};
  return grid;
}

class DeepFiles : public testing::Test {
 protected:
  DeepFiles() {
    folder.write("wall.gltf", sceneText(true, false, false));
    folder.write("all.gltf", sceneText(true, true, true));
    folder.write("smoke.gltf", sceneText(true, true, false));
    folder.write("card.gltf", sceneText(false, false, true));
  }
  Arguments draft(Arguments arguments) const {
    arguments.insert(arguments.begin(), "render");
    arguments.insert(arguments.end(), {"--res", "64x48", "-q"});
    return arguments;
  }
  void render(const Arguments& arguments) const {
    const Outcome outcome = runProgram(folder.path(), draft(arguments));
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  }
  std::filesystem::path path(const std::string& name) const { return folder.path() / name; }
  // False where there is no oiiotool.
  bool oiiotool(const std::string& arguments) const {
    const std::string command =
        "cd '" + folder.path().string() + "' && oiiotool " + arguments + " > tool.txt 2>&1";
    const int status = std::system(command.c_str());
    if (WEXITSTATUS(status) == 127) return false;
    EXPECT_EQ(status, 0) << contentOf(path("tool.txt"));
    return true;
  }
  std::set<std::string> names() const {
    std::set<std::string> all;
    for (const auto& [name, content] : listing(folder.path())) all.insert(name);
    return all;
  }

  TemporaryFolder folder{"deep_files"};
};

class DeepFilesRender : public DeepFiles {
 protected:
  void SetUp() override {
    tests::needDevice();
    try {
      volumes::writeVdb(path("ball.vdb"), ball());
    } catch (const base::Error&) {
      GTEST_SKIP() << "this build has no OpenVDB";
    }
  }
};

TEST_F(DeepFiles, RefusesWhatCannotBe) {
  ASSERT_EQ(mkfifo(path("pipe.exr").c_str(), 0600), 0);
  const auto call = [&](const Arguments& arguments, int exitCode, const std::string& says) {
    return BadCall{draft(arguments), exitCode, says};
  };
  expectErrors(
      folder.path(),
      {
          call({"wall.gltf", "--deep", "out.png"}, 2, "out.png: is not the name of a deep image: use .exr"),
          call({"wall.gltf", "--deep", "out"}, 2, "unknown image ending"),
          call({"wall.gltf", "--deep", "a.exr", "-o", "a.exr"}, 2, "a.exr: is named twice"),
          call({"wall.gltf", "--deep", "a.exr", "--deep-shadow", "sun", "./a.exr"}, 2, "is named twice"),
          call({"wall.gltf", "--deep", "missing/a.exr"}, 3, "missing/a.exr: cannot be written"),
          call({"wall.gltf", "--deep", "pipe.exr"}, 3, "pipe.exr: is a device or a pipe"),
          call({"wall.gltf", "--deep", "a.exr", "--reference"}, 2, "--reference has no lists"),
          call({"wall.gltf", "--deep-shadow", "sun", "a.exr", "--reference"}, 2, "--reference has no lists"),
          call({"wall.gltf", "--deep-shadow", "moon", "a.exr"}, 2,
               "no light \"moon\": choose one of \"sun\", \"lamp\", or a number, 0 to 1"),
          call({"wall.gltf", "--deep-shadow", "2", "a.exr"}, 2, "no light \"2\""),
          call({"wall.gltf", "--deep-shadow", "-1", "a.exr"}, 2, "no light \"-1\""),
          call({"wall.gltf", "--deep-shadow", "sun", "a.png"}, 2, "a.png: is not the name of a deep image"),
          {{"render", "wall.gltf", "--deep-shadow", "sun"}, 2, "--deep-shadow"},
          {{"render", "wall.gltf", "--deep"}, 2, "--deep"},
          call({"wall.gltf", "--deep", "a.exr", "--aov", "depth"}, 2, "only an .exr holds it"),
      });
}

TEST_F(DeepFilesRender, ADeepImageAloneIsEnough) {
  const auto before = names();
  render({"wall.gltf", "--deep", "deep.exr", "--quality", "draft"});
  auto after = names();
  EXPECT_EQ(after.erase("deep.exr"), 1u);
  EXPECT_EQ(after, before);
  const image::Image flat = image::readImage(path("deep.exr"));
  EXPECT_NEAR(flat.pixel(32, 24)[0], 0.3, 2e-4);
  EXPECT_NEAR(flat.pixel(32, 24)[2], 0.1, 1e-4);
}

// Where the disk is full, also where only its last bytes find no room.
TEST_F(DeepFilesRender, AFullDiskLeavesNoFile) {
  render({"wall.gltf", "--deep", "deep.exr", "--quality", "draft"});
  const auto bytes = static_cast<rlim_t>(std::filesystem::file_size(path("deep.exr")));
  std::filesystem::remove(path("deep.exr"));
  const auto before = listing(folder.path());
  for (const rlim_t room : {rlim_t{100}, bytes / 2, bytes - 1}) {
    const auto fillDisk = [&] {
      std::signal(SIGXFSZ, SIG_IGN);
      const rlimit limit{room, room};
      setrlimit(RLIMIT_FSIZE, &limit);
    };
    expectError(runProgram(folder.path(), draft({"wall.gltf", "--deep", "deep.exr", "--quality", "draft"}),
                           {.inChild = fillDisk}),
                3, "deep.exr: cannot be written");
    EXPECT_EQ(listing(folder.path()), before) << room;
  }
}

// The rounding of halves, of the picture and of the deep image.
constexpr double halves = 0x1p-10;

double worstDifference(const image::Image& a, const image::Image& b) {
  double worst = 0;
  for (size_t i = 0; i < a.values.size(); ++i)
    worst = std::max(worst, std::abs(double(a.values[i]) - b.values[i]) / (0.01 + b.values[i]));
  return worst;
}

TEST_F(DeepFilesRender, FlattenedByOiiotoolItIsThePicture) {
  render({"all.gltf", "--deep", "deep.exr", "-o", "flat.exr"});
  const image::Image picture = image::readImage(path("flat.exr"));
  EXPECT_LT(worstDifference(image::readImage(path("deep.exr")), picture), halves);
  if (!oiiotool("deep.exr --flatten --ch R,G,B -o tool.exr")) GTEST_SKIP() << "there is no oiiotool";
  EXPECT_LT(worstDifference(image::readImage(path("tool.exr")), picture), halves);
}

// The workflow of a compositor: smoke and card are drawn apart, merged as deep images, and flattened. The
// card gets a thickness, because OpenImageIO 2.4 puts a surface behind the rest of a sample of smoke that it
// cuts.
TEST_F(DeepFilesRender, MergedByOiiotoolACardStandsInTheSmoke) {
  render({"smoke.gltf", "--deep", "smoke.exr", "--step", "0.5"});
  render({"card.gltf", "--deep", "card.exr"});
  render({"all.gltf", "-o", "all.exr", "--step", "0.5"});
  if (!oiiotool("card.exr --addc 0,0,0,0,0,0.0001 smoke.exr --deepmerge --flatten --ch R,G,B -o merged.exr"))
    GTEST_SKIP() << "there is no oiiotool";
  const image::Image merged = image::readImage(path("merged.exr"));
  const image::Image drawn = image::readImage(path("all.exr"));
  const image::Image smoke = image::readImage(path("smoke.exr"));
  double worst = 0;
  double withoutCard = 0;
  for (int y = 0; y < drawn.height; ++y)
    for (int x = 0; x < drawn.width; ++x) {
      const double right = std::abs(x + 0.5 - 32) / 24 * std::tan(0.25) * (5 - cardZ);
      const double up = std::abs(y + 0.5 - 24) / 24 * std::tan(0.25) * (5 - cardZ);
      constexpr double pixel = 0.06;                              // m
      if (std::abs(std::max(right, up) - 0.5) < pixel) continue;  // the card's edge: see tests/pipelines
      for (int c = 0; c < 3; ++c) {
        worst = std::max(worst, std::abs(double(merged.pixel(x, y)[c]) - drawn.pixel(x, y)[c]));
        withoutCard = std::max(withoutCard, std::abs(double(smoke.pixel(x, y)[c]) - drawn.pixel(x, y)[c]));
      }
    }
  EXPECT_LT(worst, (1 + *std::max_element(drawn.values.begin(), drawn.values.end())) / 512);
  EXPECT_GT(withoutCard, 0.2);
}

TEST_F(DeepFilesRender, ALightsMapHasAPartForEachFace) {
  render({"all.gltf", "--deep-shadow", "sun", "sun.exr", "--deep-shadow", "1", "lamp.exr", "--shadow-res",
          "64"});
  const image::Image sun = image::readImage(path("sun.exr"));
  EXPECT_EQ(sun.width, 64);
  EXPECT_EQ(sun.height, 64);
  for (const float value : sun.values) ASSERT_EQ(value, 0.f);  // a shadow is black
  if (!oiiotool("--info -v -a lamp.exr")) GTEST_SKIP() << "there is no oiiotool";
  const std::string told = contentOf(path("tool.txt"));
  for (const char* says : {"6 subimages", "32 x   32", "+x", "-x", "+y", "-y", "+z", "-z", "worldToCamera",
                           "worldToNDC", "sfumato:light: \"1\"", "deep half", "zips"})
    EXPECT_NE(told.find(says), std::string::npos) << says << " is not in " << told;
}

}  // namespace
}  // namespace sfumato::test
