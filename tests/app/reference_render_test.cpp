// `sfumato render --reference`, which needs no OpenGL, and what every picture says of itself.
#include <gtest/gtest.h>

#include "image/image_file.h"
#include "image/metrics.h"
#include "tests/app/program.h"
#include "tests/image/openimageio.h"
#include "volumes/procedural_smoke.h"
#include "volumes/vdb_file.h"

namespace sfumato::test {
namespace {

const Surroundings noEgl{.environment = {"__EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent.json"}};

// A glowing triangle in front of a camera.
std::string scene() {
  GltfBuilder gltf = triangle();
  gltf.add("materials", {{"emissiveFactor", {1, 0.5, 0.25}}, {"doubleSided", true}});
  gltf.json["meshes"][0]["primitives"][0]["material"] = 0;
  gltf.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}});
  gltf.add("nodes", {{"camera", 0}, {"name", "front"}, {"translation", {0.3, 0.3, 2}}});
  gltf.light({{"type", "point"}, {"intensity", 5}})["translation"] = {0.5, 0.5, 2};
  return gltf.text();
}

class ReferenceRender : public testing::Test {
 protected:
  void SetUp() override {
    if (!hasOpenImageIO()) GTEST_SKIP() << "built without OpenImageIO";
    folder.write("scene.gltf", scene());
  }
  Outcome run(Arguments arguments, const Surroundings& surroundings = noEgl) const {
    arguments.insert(arguments.begin(), {"render", "--res", "24x16"});
    return runProgram(folder.path(), arguments, surroundings);
  }
  void render(const Arguments& arguments) const {
    const Outcome outcome = run(arguments);
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  }
  void writeSmoke(const glm::dmat4& worldFromGrid = glm::dmat4(1)) {
    volumes::DensityGrid plume = volumes::makePlume(16, 1, 3);
    plume.worldFromIndex = worldFromGrid * plume.worldFromIndex;
    try {
      volumes::writeVdb(folder.path() / "smoke.vdb", plume);
    } catch (const base::Error& error) {
      GTEST_SKIP() << error.what();
    }
  }
  image::Image picture(const std::string& name) const { return image::readImage(folder.path() / name); }

  TemporaryFolder folder{"reference_render"};
};

TEST_F(ReferenceRender, DrawsWithoutOpenGl) {
  const Outcome outcome = run({"scene.gltf", "--reference", "-o", "out.exr", "--stats", "out.json"});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_NE(outcome.err.find("reference: 100% "), std::string::npos) << outcome.err;
  // The middle of the picture looks at (0.3, 0.3, 0), which glows.
  const float* middle = picture("out.exr").pixel(12, 8);
  EXPECT_GE(middle[0], 1.f);
  EXPECT_EQ(picture("out.exr").pixel(0, 0)[0], 0.f);
  const Json figures = Json::parse(contentOf(folder.path() / "out.json"));
  EXPECT_EQ(figures["device"], "CPU reference");
  EXPECT_EQ(figures["frame"]["seconds"].size(), 1u);
}

TEST_F(ReferenceRender, SamplesSmoothEdges) {
  render({"scene.gltf", "--reference", "-o", "one.exr"});
  render({"scene.gltf", "--reference", "--samples", "4", "-o", "four.exr"});
  const auto between = [](const image::Image& image) {  // pixels that a part of the triangle covers
    int count = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const float red = image.pixel(x, y)[0];
        count += red > 0.05f && red < 0.95f ? 1 : 0;
      }
    return count;
  };
  EXPECT_EQ(between(picture("one.exr")), 0);
  EXPECT_GT(between(picture("four.exr")), 10);
}

TEST_F(ReferenceRender, TellsDepthAndFragments) {
  render({"scene.gltf", "--reference", "--aov", "depth,fragments", "-o", "out.exr", "-o", "out.png"});
  const image::Image depth = image::readLayer(folder.path() / "out.exr", "depth").image;
  EXPECT_NEAR(*depth.pixel(12, 8), 2, 1e-6);
  EXPECT_TRUE(std::isinf(*depth.pixel(0, 0)));
  EXPECT_EQ(*image::readLayer(folder.path() / "out.exr", "fragments").image.pixel(12, 8), 0);
  EXPECT_EQ(picture("out.fragments.png").height, 16);
}

TEST_F(ReferenceRender, SamplesAreOfTheReference) {
  expectError(run({"scene.gltf", "--samples", "4", "-o", "out.exr"}), 2, "--samples requires --reference");
  expectError(run({"scene.gltf", "--reference", "--samples", "0", "-o", "out.exr"}), 2, "--samples: \"0\"");
}

TEST_F(ReferenceRender, SamePictureAndSettingsEveryTime) {
  const Arguments arguments = {"scene.gltf", "--reference", "-o", "out.exr", "-o", "out.png", "-q"};
  render(arguments);
  const auto first = listing(folder.path());
  sleep(1);  // a time of day would have another second
  render(arguments);
  EXPECT_TRUE(listing(folder.path()) == first);
}

TEST_F(ReferenceRender, PicturesSayWhatMadeThem) {
  render({"scene.gltf", "--reference", "--samples", "2", "--step", "0.75", "--exposure", "1.5", "-o",
          "it's.exr", "-o", "out.png"});
  for (const char* name : {"it's.exr", "out.png"}) {
    const std::string bytes = contentOf(folder.path() / name);
    for (
        const char* part :
        {"sfumato 0.", "CPU reference",
         R"(sfumato render --res 24x16 scene.gltf --reference --samples 2 --step 0.75 --exposure 1.5 -o 'it'\''s.exr')",
         "24x16", "medium", "0.3 0.3 2", "40.10704565915762"})
      EXPECT_NE(bytes.find(part), std::string::npos) << name << " lacks " << part;
  }
}

TEST_F(ReferenceRender, ToneMapsWithoutOpenGl) {
  render({"scene.gltf", "--reference", "-o", "plain.exr", "-o", "plain.png"});
  render({"scene.gltf", "--reference", "--tonemap", "reinhard", "-o", "out.exr", "-o", "out.png"});
  EXPECT_EQ(picture("out.exr").values, picture("plain.exr").values);
  EXPECT_NE(picture("out.png").values, picture("plain.png").values);
  EXPECT_NE(contentOf(folder.path() / "out.png").find("log_average_luminance"), std::string::npos);
  EXPECT_EQ(contentOf(folder.path() / "out.exr").find("log_average_luminance"), std::string::npos);
}

TEST_F(ReferenceRender, SaysWhatNeedsOpenGl) {
  const auto before = listing(folder.path());
  for (const Arguments& effect : {Arguments{"--bloom", "mipmap"}, Arguments{"--aa", "edges"}}) {
    Arguments arguments = {"scene.gltf", "--reference", "-q", "-o", "out.png"};
    arguments.insert(arguments.end(), effect.begin(), effect.end());
    expectError(run(arguments), 4, "--bloom, --aa: need OpenGL");
    EXPECT_EQ(listing(folder.path()), before);
  }
}

TEST_F(ReferenceRender, NamesTheFlagThatHasNothingToActOn) {
  expectError(run({"scene.gltf", "-o", "out.png", "--white", "2"}), 2, "--white: is of a curve");
  expectError(run({"scene.gltf", "-o", "out.png", "--bloom-strength", "1"}), 2,
              "--bloom-strength: of no bloom");
  for (const Arguments& flag :
       {Arguments{"--tonemap", "reinhard"}, Arguments{"--bloom", "mipmap"}, Arguments{"--aa", "edges"}}) {
    Arguments arguments = {"scene.gltf", "-o", "out.exr"};
    arguments.insert(arguments.end(), flag.begin(), flag.end());
    expectError(run(arguments), 2, flag[0] + ": shapes a .png only");
  }
}

TEST_F(ReferenceRender, PutsSmokeAloneIntoASet) {
  ASSERT_NO_FATAL_FAILURE(writeSmoke());
  if (IsSkipped()) return;
  const Outcome outcome = run({"--volume", "smoke.vdb", "--reference", "-o", "out.exr", "-v"});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("smoke.vdb: --volume-scale "), std::string::npos) << outcome.err;
  const image::Image image = picture("out.exr");
  for (const float value : image.values) EXPECT_GT(value, 0);  // ground or smoke everywhere
  render({"--volume", "smoke.vdb", "--volume-scale", "0", "--reference", "-o", "empty.exr"});
  EXPECT_GT(image::compare(image, picture("empty.exr")).relativeRmse, 0.3);  // the smoke shows
}

TEST_F(ReferenceRender, ShowsSmokeOfAnySizeAlike) {
  ASSERT_NO_FATAL_FAILURE(writeSmoke());
  if (IsSkipped()) return;
  render({"--volume", "smoke.vdb", "--reference", "-o", "expected.exr"});
  for (const double scale : {1e-3, 1e3}) {
    glm::dmat4 worldFromGrid(scale);
    worldFromGrid[3] = {-70 * scale, 40 * scale, 1000 * scale, 1};
    writeSmoke(worldFromGrid);
    render({"--volume", "smoke.vdb", "--reference", "-o", "out.exr"});
    EXPECT_LT(image::compare(picture("out.exr"), picture("expected.exr")).relativeRmse, 0.01) << scale;
  }
}

TEST_F(ReferenceRender, AsksForAScene) {
  expectError(run({"--reference", "-o", "out.png"}), 2,
              "render: no scene: name a .gltf or .glb file, or smoke");
  expectError(run({"--volume", "missing.vdb", "-o", "out.png"}), 3, "missing.vdb: cannot be read");
  expectError(run({"--volume", "missing.vdb"}), 2, "-o missing.png");
}

}  // namespace
}  // namespace sfumato::test
