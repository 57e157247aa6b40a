// What users feed the program by mistake, from the file to the exit code: one line each, or a right picture.
// tests/scene and tests/volumes look at each loader closely.
#include <cmath>

#include "base/error.h"
#include "image/image_file.h"
#include "tests/app/program.h"
#include "tests/gl/test_device.h"
#include "volumes/vdb_file.h"

namespace sfumato::test {
namespace {

constexpr size_t camera = 1;  // node
constexpr size_t lamp = 2;    // node

Json& lens(GltfBuilder& gltf) {
  return gltf.json["cameras"][0]["perspective"];
}

void makeOrthographic(GltfBuilder& gltf, double xMagnitude, double yMagnitude, double zNear, double zFar) {
  gltf.json["cameras"][0] = {
      {"type", "orthographic"},
      {"orthographic", {{"xmag", xMagnitude}, {"ymag", yMagnitude}, {"znear", zNear}, {"zfar", zFar}}}};
}

class BadInput : public testing::Test {
 protected:
  Outcome render(Arguments arguments, int seconds = 60) const {
    arguments.insert(arguments.begin(), "render");
    arguments.insert(arguments.end(), {"--res", "32x24", "--quality", "draft", "-q", "-o", "out.exr"});
    return runProgram(folder.path(), arguments, {.seconds = seconds});
  }
  void expectRefused(const std::string& name, const GltfBuilder& gltf, int exitCode,
                     const std::string& says) {
    SCOPED_TRACE(name);
    folder.write("bad.gltf", gltf.text());
    const auto before = listing(folder.path());
    expectError(render({"bad.gltf"}), exitCode, says);
    EXPECT_EQ(listing(folder.path()), before);
  }

  TemporaryFolder folder{"bad_input"};
};

TEST_F(BadInput, OfVerticesAndNodesIsNamed) {
  const float nan = std::nanf("");
  const float inf = HUGE_VALF;
  expectRefused("NaN", glowingScene({0, 0, 0, 1, nan, 0, 0, 1, 0}), 3, "element 1 is not finite");
  expectRefused("infinity", glowingScene({0, 0, 0, 1, 0, 0, 0, -inf, 0}), 3, "element 2 is not finite");
  expectRefused("all but infinity", glowingScene({0, 0, 0, 3e38f, 0, 0, 0, 1, 0}), 3, "reaches 3e+38 m");
  expectRefused("index", glowingScene({0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 7}), 3, "index 2 is 7");
  GltfBuilder cycle = glowingScene();
  cycle.json["nodes"][0]["children"] = {3};
  cycle.add("nodes", {{"children", {0}}});
  expectRefused("cycle", cycle, 3, "its own ancestor");
  folder.write("not.png", "This is no picture.");
  GltfBuilder texture = glowingScene();
  texture.add("images", {{"uri", "not.png"}});
  texture.add("textures", {{"source", 0}});
  texture.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 0;
  expectRefused("picture", texture, 3, "image 0: is not a PNG or JPEG");
}

TEST_F(BadInput, OfCamerasIsNamed) {
  GltfBuilder gltf = glowingScene();
  lens(gltf)["yfov"] = 0;
  expectRefused("yfov", gltf, 3, "camera yfov is 0");
  gltf = glowingScene();
  lens(gltf)["zfar"] = 0.1;
  expectRefused("near = far", gltf, 3, "zfar 0.1 is not beyond znear 0.1");
  makeOrthographic(gltf, 1, 0, 0, 10);
  expectRefused("ymag", gltf, 3, "camera ymag is 0");
  makeOrthographic(gltf, 1, 1, 5, 5);
  expectRefused("orthographic near = far", gltf, 3, "zfar 5 is not beyond znear 5");
  gltf = glowingScene();
  gltf.json["nodes"][camera]["scale"] = {0, 0, 0};
  expectRefused("scale", gltf, 3, "leaves no direction");
}

TEST_F(BadInput, OfSmokeIsNamed) {
  volumes::DensityGrid grid;
  grid.name = "density";
  grid.size = glm::ivec3(4);
  // A NaN is left out by writeVdb() itself; tests/volumes writes one with OpenVDB.
  for (const auto& [value, says] : {std::pair(0.f, "is empty"), {-1.f, "density -1"}, {HUGE_VALF, "inf"}}) {
    SCOPED_TRACE(says);
    grid.values.assign(64, 0.f);
    grid.values[21] = value;
    try {
      volumes::writeVdb(folder.path() / "bad.vdb", grid);
    } catch (const base::Error& error) {
      GTEST_SKIP() << error.what();
    }
    expectError(render({"--volume", "bad.vdb"}), 3, says);
    GltfBuilder gltf = glowingScene();
    gltf.add("nodes", {{"extras", {{"volume", "bad.vdb"}}}});
    expectRefused("by a node", gltf, 3, says);
  }
}

class OddInput : public BadInput {
 protected:
  void SetUp() override { tests::needDevice(); }
  image::Image drawn(const GltfBuilder& gltf, const std::string& name = "odd.gltf") {
    folder.write(name, gltf.text());
    const Outcome outcome = render({name});
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    return image::readImage(folder.path() / "out.exr");
  }
};

TEST_F(OddInput, OfCamerasGivesTheRightPicture) {
  const std::vector<float> expected = drawn(glowingScene()).values;
  EXPECT_GE(*std::max_element(expected.begin(), expected.end()), 1);
  GltfBuilder gltf = glowingScene();
  lens(gltf)["aspectRatio"] = 0;  // the picture has its own
  EXPECT_EQ(drawn(gltf).values, expected);
  gltf = glowingScene();
  lens(gltf)["znear"] = 1e-300;
  EXPECT_EQ(drawn(gltf).values, expected);
  makeOrthographic(gltf, 1, 1, 0, 10);
  const std::vector<float> orthographic = drawn(gltf).values;
  makeOrthographic(gltf, 0, 1, 0, 10);
  EXPECT_EQ(drawn(gltf).values, orthographic);
}

TEST_F(OddInput, OfAHundredThousandNodesIsDrawnInTime) {
  constexpr int nodes = 100'000;
  const auto where = [](int i) { return Json{i % 316 * 0.002, i / 316 * 0.002, -1e-5 * i}; };
  GltfBuilder meshes = glowingScene();
  for (int i = 0; i < nodes; ++i)
    meshes.add("nodes", {{"mesh", 0}, {"translation", where(i)}, {"scale", {1e-3, 1e-3, 1e-3}}});
  EXPECT_GE(drawn(meshes).pixel(16, 12)[0], 1);
  GltfBuilder chain = glowingScene();
  for (int i = 0; i < nodes; ++i) chain.add("nodes", {{"children", {i + 4}}});
  chain.add("nodes", Json::object());
  EXPECT_EQ(drawn(chain).values, drawn(glowingScene()).values);
  GltfBuilder lamps = glowingScene();
  for (int i = 0; i < nodes; ++i) lamps.add("nodes", lamps.json["nodes"][lamp]);
  expectRefused("lamps", lamps, 5, "--shadow-memory");
}

TEST_F(OddInput, WithSpacesAndOtherLettersInNames) {
  std::filesystem::create_directory(folder.path() / "ein Ordner");
  GltfBuilder gltf = glowingScene();
  gltf.json["buffers"] = Json::array({{{"byteLength", gltf.buffer.size()}, {"uri", "Größe%20煙.bin"}}});
  folder.write("ein Ordner/Größe 煙.bin", std::string(gltf.buffer.begin(), gltf.buffer.end()));
  EXPECT_EQ(drawn(gltf, "ein Ordner/Größe 煙.gltf").values, drawn(glowingScene()).values);
}

}  // namespace
}  // namespace sfumato::test
