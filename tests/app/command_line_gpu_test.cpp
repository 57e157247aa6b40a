// The program as a stranger meets it: bad input, bad surroundings, odd scenes, and what it leaves behind.
#include <sys/resource.h>
#include <sys/stat.h>

#include <set>

#include "base/error.h"
#include "image/image_file.h"
#include "image/metrics.h"
#include "lists/driver_verdict.h"
#include "pipelines/pipeline_names.h"
#include "tests/app/program.h"
#include "tests/gl/test_device.h"
#include "volumes/vdb_file.h"

namespace sfumato::test {
namespace {

// A glowing triangle (0,0,0) (1,0,0) (0,1,0), no camera, no light.
GltfBuilder glowingTriangle() {
  GltfBuilder gltf = triangle();
  gltf.add("materials", {{"emissiveFactor", {1, 1, 1}}, {"doubleSided", true}});
  gltf.json["meshes"][0]["primitives"][0]["material"] = 0;
  return gltf;
}

void addCamera(GltfBuilder& gltf, const std::string& name) {
  const int camera =
      gltf.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}});
  gltf.add("nodes", {{"camera", camera}, {"name", name}, {"translation", {0.3, 0.3, 2}}});
}

GltfBuilder wholeScene() {
  GltfBuilder gltf = glowingTriangle();
  addCamera(gltf, "front");
  addCamera(gltf, "the other");
  gltf.light({{"type", "point"}, {"intensity", 5}})["translation"] = {0.5, 0.5, 2};
  return gltf;
}

std::string sceneWithVolume(const std::string& file) {
  GltfBuilder gltf = wholeScene();
  gltf.add("nodes", {{"extras", {{"volume", file}}}});
  return gltf.text();
}

// Smoke in a cube of 0.8 m about (5, 5, 5).
volumes::DensityGrid smoke() {
  volumes::DensityGrid grid;
  grid.name = "density";
  grid.size = glm::ivec3(8);
  grid.values.assign(512, 0.f);
  for (int z = 1; z < 7; ++z)
    for (int y = 1; y < 7; ++y)
      for (int x = 1; x < 7; ++x) grid.values[grid.valueIndex(x, y, z)] = 10.f;
  for (int axis = 0; axis < 3; ++axis) grid.worldFromIndex[axis][axis] = 0.1;
  grid.worldFromIndex[3] = {4.65, 4.65, 4.65, 1};
  return grid;
}

Arguments draft(Arguments arguments, const std::string& resolution = "64x48") {
  arguments.insert(arguments.begin(), "render");
  arguments.insert(arguments.end(), {"--res", resolution, "--quality", "draft"});
  return arguments;
}

float sumOf(const image::Image& image) {
  float sum = 0;
  for (const float value : image.values) sum += value;
  return sum;
}

// A folder with scene.gltf in it, in which the program runs.
class CommandLineGpu : public testing::Test {
 protected:
  CommandLineGpu() { folder.write("scene.gltf", wholeScene().text()); }

  Outcome run(const Arguments& arguments, const Surroundings& surroundings = {}) const {
    return runProgram(folder.path(), arguments, surroundings);
  }
  // Renders, and expects that to go well.
  void render(const Arguments& arguments, const std::string& resolution = "64x48",
              const Surroundings& surroundings = {}) const {
    const Outcome outcome = run(draft(arguments, resolution), surroundings);
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  }
  std::filesystem::path path(const std::string& name) const { return folder.path() / name; }
  image::Image picture(const std::string& name) const { return image::readImage(path(name)); }
  // Names that are there now and were not `before`.
  std::set<std::string> newNames(const std::map<std::string, std::string>& before) const {
    std::set<std::string> names;
    for (const auto& [name, content] : listing(folder.path()))
      if (!before.contains(name)) names.insert(name);
    return names;
  }

  TemporaryFolder folder{"command_line_gpu"};
};

// The same where a frame is drawn: skips without a device.
class CommandLineRender : public CommandLineGpu {
 protected:
  void SetUp() override { tests::needDevice(); }
};

// ---- bad input -------------------------------------------------------------------------------------------

TEST_F(CommandLineGpu, NamesTheFileThatIsWrong) {
  const std::string whole = wholeScene().text();
  std::string lying = wholeScene().binary();
  lying[8] = '\x7f';  // its length
  std::string lyingChunk = wholeScene().binary();
  lyingChunk[15] = '\x7f';  // 2 GiB of JSON
  folder.write("cut.gltf", whole.substr(0, whole.size() / 2));
  folder.write("empty.gltf", "");
  folder.write("lying.glb", lying);
  folder.write("lying_chunk.glb", lyingChunk);
  folder.write("cut.glb", wholeScene().binary().substr(0, 100));
  folder.write("garbage.vdb", "This is no smoke.");
  folder.write("empty.vdb", "");
  folder.write("missing_smoke.gltf", sceneWithVolume("missing.vdb"));
  folder.write("garbage_smoke.gltf", sceneWithVolume("garbage.vdb"));
  std::filesystem::create_directory(path("folder"));
  std::filesystem::create_directory(path("folder.png"));
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);

  const auto to = [](Arguments arguments) {
    arguments.insert(arguments.begin(), "render");
    arguments.insert(arguments.end(), {"-o", "out.png"});
    return arguments;
  };
  expectErrors(
      folder.path(),
      {
          {{"render"}, 2, "no scene"},
          {{"render", "scene.gltf"}, 2, "no output"},
          {to({"missing.gltf"}), 3, "missing.gltf: cannot be read"},
          {to({"two\nlines.gltf"}), 3, "two?lines.gltf: cannot be read"},
          {to({"folder"}), 3, "folder: is a folder"},
          {to({"pipe"}), 3, "pipe: is a device or a pipe"},
          {to({"cut.gltf"}), 3, "cut.gltf: "},
          {to({"empty.gltf"}), 3, "empty.gltf: "},
          {to({"lying.glb"}), 3, "lying.glb: is damaged"},
          {to({"lying_chunk.glb"}), 3, "lying_chunk.glb: is damaged"},
          {to({"cut.glb"}), 3, "cut.glb: is damaged"},
          {to({"scene.gltf", "--volume", "missing.vdb"}), 3, "missing.vdb: cannot be read"},
          {to({"scene.gltf", "--volume", "garbage.vdb"}), 3, "garbage.vdb: is not an OpenVDB file"},
          {to({"scene.gltf", "--volume", "empty.vdb"}), 3, "empty.vdb: is empty"},
          {to({"scene.gltf", "--volume", "folder"}), 3, "folder: is a folder"},
          {to({"scene.gltf", "--volume", "pipe"}), 3, "pipe: is a device or a pipe"},
          {to({"missing_smoke.gltf"}), 3, "missing.vdb: cannot be read"},
          {to({"garbage_smoke.gltf"}), 3, "garbage.vdb: is not an OpenVDB file"},
          {{"render", "scene.gltf", "-o", "nowhere/out.png"}, 3, "nowhere/out.png: cannot be written"},
          {{"render", "scene.gltf", "-o", "/proc/out.png"}, 3, "/proc/out.png: cannot be written"},
          {{"render", "scene.gltf", "-o", "folder.png"}, 3, "folder.png: is a folder"},
          {{"render", "scene.gltf", "-o", "out.tga"}, 2, "out.tga: unknown image ending"},
          {{"render", "scene.gltf", "-o", "out"}, 2, "out: unknown image ending"},
          {to({"scene.gltf", "-o", "out.tga"}), 2, "out.tga: unknown image ending"},
          {to({"scene.gltf", "--stats", "folder"}), 3, "folder: is a folder"},
          {to({"scene.gltf", "--stats", "nowhere/s.json"}), 3, "nowhere/s.json: cannot be written"},
          {to({"scene.gltf", "-o", "./out.png"}), 2, "out.png: is named twice"},
          {to({"scene.gltf", "--stats", "folder/../out.png"}), 2, "out.png: is named twice"},
          {to({"scene.gltf", "--stats", "scene.gltf"}), 2, "scene.gltf: is named twice"},
          {to({"scene.gltf", "--volume", "empty.vdb", "--stats", "empty.vdb"}), 2, "is named twice"},
          {to({"scene.gltf", "--camera", "back"}), 2,
           "no camera \"back\" in scene.gltf: choose one of \"front\", \"the other\""},
          {to({"scene.gltf", "--look-from", "1", "2", "3", "--look-at", "1", "2", "3"}), 2,
           "--look-at: is where"},
      });
}

TEST_F(CommandLineGpu, NamesTheSmokeThatIsWrong) {
  try {
    volumes::writeVdb(path("smoke.vdb"), smoke());
  } catch (const base::Error& error) {
    GTEST_SKIP() << error.what();
  }
  const std::string whole = contentOf(path("smoke.vdb"));
  folder.write("cut.vdb", whole.substr(0, whole.size() * 3 / 4));
  folder.write("cut_smoke.gltf", sceneWithVolume("cut.vdb"));
  expectErrors(folder.path(),
               {
                   {{"render", "scene.gltf", "-o", "out.png", "--volume", "cut.vdb"}, 3, "cut.vdb: "},
                   {{"render", "cut_smoke.gltf", "-o", "out.png"}, 3, "cut.vdb: "},
                   {{"render", "scene.gltf", "-o", "out.png", "--volume", "smoke.vdb", "--grid", "heat"},
                    3,
                    "smoke.vdb: no "},
               });
}

// ---- bad surroundings ------------------------------------------------------------------------------------

// libEGL finds no driver to ask, whatever is installed.
const Surroundings noEgl{.environment = {"__EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent.json"}};

TEST_F(CommandLineGpu, SaysThatThereIsNoOpenGl) {
  const auto before = listing(folder.path());
  expectError(run(draft({"scene.gltf", "-o", "out.png"}), noEgl), 4, "no usable OpenGL 4.3");
  expectError(run({"info"}, noEgl), 4, "no usable OpenGL 4.3");
  expectError(run({"info", "--json"}, noEgl), 4, "no usable OpenGL 4.3");
  EXPECT_EQ(listing(folder.path()), before);
}

TEST_F(CommandLineRender, SaysThatTheDriverIsTooOldOrMissing) {
  const gl::DeviceNames& names = tests::testDevice()->names();
  if (names.version.find("Mesa") == std::string::npos)
    GTEST_SKIP() << "only Mesa's drivers can be made older, this one is " << names.renderer;
  const Arguments call = draft({"scene.gltf", "-o", "out.png"});
  for (const char* older : {"GALLIUM_DRIVER=softpipe", "MESA_GL_VERSION_OVERRIDE=3.3"})
    expectError(run(call, {.environment = {older}}), 4, "no OpenGL 4.3 core context");
  EXPECT_FALSE(std::filesystem::exists(path("out.png")));
  const Outcome missing = run(call, {.environment = {"LIBGL_DRIVERS_PATH=/nonexistent"}});
  if (missing.exitCode != 0)  // Mesa from 24.3 on finds its drivers elsewhere
    expectError(missing, 4, "eglInitialize failed");
}

TEST_F(CommandLineRender, SaysWhichDevicesThereAre) {
  for (const char* choice : {"99", "no such name"}) {
    const std::string renderer = tests::testDevice()->names().renderer;
    expectError(run(draft({"scene.gltf", "-o", "out.png", "--device", choice})), 4, renderer);
    expectError(run({"info", "--device", choice}), 4, renderer);
  }
}

// Sides up to the largest, and more pixels than a tile has.
TEST_F(CommandLineRender, DrawsImagesOfAnyShape) {
  for (const auto& [width, height] :
       {std::pair(16384, 64), {64, 16384}, {1, 16384}, {16384, 3}, {2500, 1700}}) {
    const std::string resolution = std::to_string(width) + "x" + std::to_string(height);
    SCOPED_TRACE(resolution);
    render({"scene.gltf", "-q", "-o", "out.exr", "--stats", "out.json"}, resolution);
    const image::Image image = picture("out.exr");
    EXPECT_EQ(image.width, width);
    EXPECT_EQ(image.height, height);
    EXPECT_GT(sumOf(image), 0);
    const Json figures = Json::parse(contentOf(path("out.json")));
    EXPECT_EQ(figures["frame"]["tiles"], width * height > 2097152 ? 4 : 1);
    EXPECT_EQ(figures["lists"]["surfaces"]["cells"], width * height);
  }
}

TEST_F(CommandLineRender, LeavesNothingOnAFullDisk) {
  struct Row {
    std::string name;
    Arguments outputs;
    rlim_t room;  // bytes of the largest file: in the last row the picture fits and the figures do not
  };
  for (const Row& row : std::vector<Row>{{"out.png", {"-o", "out.png"}, 100},
                                         {"out.exr", {"-o", "out.exr"}, 100},
                                         {"out.json", {"-o", "fits.png", "--stats", "out.json"}, 2000}}) {
    SCOPED_TRACE(row.name);
    const auto before = listing(folder.path());
    const auto fillDisk = [&] {
      std::signal(SIGXFSZ, SIG_IGN);
      const rlimit limit{row.room, row.room};
      setrlimit(RLIMIT_FSIZE, &limit);
    };
    Arguments arguments = draft({"scene.gltf", "-q"});
    arguments.insert(arguments.end(), row.outputs.begin(), row.outputs.end());
    expectError(run(arguments, {.inChild = fillDisk}), 3, row.name + ": cannot be written");
    std::set<std::string> left = newNames(before);
    left.erase("fits.png");
    EXPECT_EQ(left, std::set<std::string>());
  }
}

TEST_F(CommandLineRender, WritesIntoAPipeAndLeavesItOne) {
  ASSERT_EQ(mkfifo(path("figures").c_str(), 0600), 0);
  const int pipe = open(path("figures").c_str(), O_RDWR | O_NONBLOCK);  // a reader that waits for nobody
  ASSERT_GE(pipe, 0);
  render({"scene.gltf", "-o", "out.png", "--stats", "figures"});
  std::string text(1 << 16, '\0');
  const ssize_t count = read(pipe, text.data(), text.size());
  close(pipe);
  ASSERT_GT(count, 0);
  EXPECT_TRUE(Json::accept(text.substr(0, static_cast<size_t>(count))));
  EXPECT_TRUE(std::filesystem::is_fifo(path("figures")));

  const Outcome outcome = run(draft({"scene.gltf", "-q", "-o", "out.png", "--stats", "/proc/self/fd/1"}));
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_TRUE(Json::accept(outcome.out)) << outcome.out;
}

TEST_F(CommandLineRender, WritesWhereALinkPoints) {
  std::filesystem::create_directory(path("elsewhere"));
  std::filesystem::create_symlink("elsewhere/real.png", path("link.png"));
  for (int i = 0; i < 2; ++i) {  // first the file is not there yet
    render({"scene.gltf", "-o", "link.png"});
    EXPECT_TRUE(std::filesystem::is_symlink(path("link.png")));
    EXPECT_EQ(picture("elsewhere/real.png").width, 64);
  }
}

TEST_F(CommandLineRender, KeepsItsMessagesOutOfItsFiles) {
  const Arguments call = {"scene.gltf", "-v", "-o", "out.exr"};
  render(call);
  const std::string expected = contentOf(path("out.exr"));
  const auto closeAll = [] {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) close(stream);
  };
  const auto fullStderr = [] { dup2(open("/dev/full", O_WRONLY), STDERR_FILENO); };
  for (const std::function<void()>& inChild :
       {std::function<void()>(closeAll), std::function<void()>(fullStderr)}) {
    std::filesystem::remove(path("out.exr"));
    render(call, "64x48", {.inChild = inChild});
    EXPECT_TRUE(contentOf(path("out.exr")) == expected);
  }
}

// ---- odd scenes ------------------------------------------------------------------------------------------

TEST_F(CommandLineRender, DrawsScenesThatLackSomething) {
  GltfBuilder noLights = glowingTriangle();
  addCamera(noLights, "front");
  GltfBuilder noLightAtAll = glowingTriangle();
  noLightAtAll.json["materials"][0].erase("emissiveFactor");
  addCamera(noLightAtAll, "front");
  GltfBuilder noMeshes;
  addCamera(noMeshes, "front");
  noMeshes.light({{"type", "point"}});
  GltfBuilder nothing;
  nothing.json["scenes"] = Json::array({Json::object()});
  nothing.json["scene"] = 0;
  struct Row {
    std::string name;
    std::string text;
    bool warns;
    bool black;
  };
  for (const Row& row : std::vector<Row>{{"no lights", noLights.text(), true, false},
                                         {"no light at all", noLightAtAll.text(), true, false},
                                         {"no meshes", noMeshes.text(), false, true},
                                         {"nothing", nothing.text(), true, true},
                                         {"nothing at all", GltfBuilder().text(), true, true}}) {
    SCOPED_TRACE(row.name);
    folder.write("odd.gltf", row.text);
    const Outcome outcome = run(draft({"odd.gltf", "-o", "out.exr"}));
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_EQ(outcome.err.find("sfumato: warning: odd.gltf: no lights") != std::string::npos, row.warns)
        << outcome.err;
    EXPECT_EQ(sumOf(picture("out.exr")) == 0, row.black);
  }
}

// Whether the picture has light, and none at its border.
bool standsInside(const image::Image& image) {
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const bool border = x == 0 || y == 0 || x == image.width - 1 || y == image.height - 1;
      if (border && image.pixel(x, y)[0] > 0) return false;
    }
  return sumOf(image) > 0;
}

TEST_F(CommandLineRender, FramesEverythingWithoutACamera) {
  for (const double scale : {1.0, 1e-4, 1e5}) {
    GltfBuilder gltf = glowingTriangle();
    gltf.json["nodes"][0]["scale"] = {scale, scale, scale};
    folder.write("unframed.gltf", gltf.text());
    for (const char* resolution : {"64x48", "96x24", "24x96"}) {
      render({"unframed.gltf", "-o", "out.exr"}, resolution);
      EXPECT_TRUE(standsInside(picture("out.exr"))) << scale << " " << resolution;
    }
  }
}

TEST_F(CommandLineRender, FramesSmokeWithoutACamera) {
  try {
    volumes::writeVdb(path("smoke.vdb"), smoke());
  } catch (const base::Error& error) {
    GTEST_SKIP() << error.what();
  }
  GltfBuilder gltf;
  gltf.light({{"type", "point"}, {"intensity", 20}})["translation"] = {5, 7, 7};
  folder.write("only_light.gltf", gltf.text());
  render({"only_light.gltf", "--volume", "smoke.vdb", "-o", "out.exr"});
  EXPECT_TRUE(standsInside(picture("out.exr")));
}

// The set around smoke alone is the same for both ways of drawing, at any size. Draft: one sample a pixel.
TEST_F(CommandLineRender, DrawsSmokeAloneAsTheReferenceDoes) {
  for (const double scale : {1.0, 1e-2, 1e4}) {
    volumes::DensityGrid grid = smoke();
    grid.worldFromIndex = glm::dmat4(scale) * grid.worldFromIndex;
    grid.worldFromIndex[3][3] = 1;
    try {
      volumes::writeVdb(path("smoke.vdb"), grid);
    } catch (const base::Error& error) {
      GTEST_SKIP() << error.what();
    }
    const Arguments call = {"render",    "--volume", "smoke.vdb", "--res", "64x48",
                            "--quality", "high",     "--step",    "0.25"};
    Arguments gpu = call;
    gpu.insert(gpu.end(), {"-o", "gpu.exr"});
    Arguments reference = call;
    reference.insert(reference.end(), {"--reference", "--samples", "2", "-o", "reference.exr"});
    EXPECT_EQ(run(gpu).exitCode, 0);
    EXPECT_EQ(run(reference).exitCode, 0);
    const image::Difference difference = image::compare(picture("gpu.exr"), picture("reference.exr"));
    EXPECT_LT(difference.relativeRmse, 0.03) << scale;
    EXPECT_NEAR(difference.meanRatio, 1, 0.01) << scale;
  }
}

// ---- what it writes --------------------------------------------------------------------------------------

TEST_F(CommandLineRender, WritesEveryOutputAndNothingElse) {
  folder.write("Größe – 煙.gltf", wholeScene().text());
  std::filesystem::create_directory(path("ein Ordner"));
  const auto before = listing(folder.path());
  const Outcome outcome = run(draft({"Größe – 煙.gltf", "-q", "-o", "ein Ordner/煙 1.exr", "-o",
                                     "ein Ordner/煙 1.png", "--stats", "ein Ordner/Zahlen.json"}));
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_EQ(outcome.out + outcome.err, "");
  EXPECT_EQ(newNames(before),
            (std::set<std::string>{"ein Ordner/煙 1.exr", "ein Ordner/煙 1.png", "ein Ordner/Zahlen.json"}));
  for (const char* name : {"ein Ordner/煙 1.exr", "ein Ordner/煙 1.png"}) {
    EXPECT_EQ(picture(name).width, 64);
    EXPECT_EQ(picture(name).height, 48);
    EXPECT_GT(sumOf(picture(name)), 0);
  }
}

TEST_F(CommandLineRender, WritesAovsAsLayersAndHeatMaps) {
  const auto before = listing(folder.path());
  render({"scene.gltf", "-o", "out.exr", "-o", "out.png", "--aov", "depth,normal", "--aov",
          "lights,fragments,shadow-nodes,depth"});
  EXPECT_EQ(newNames(before), (std::set<std::string>{"out.exr", "out.png", "out.lights.png",
                                                     "out.fragments.png", "out.shadow-nodes.png"}));
  render({"scene.gltf", "-o", "plain.exr"});
  EXPECT_EQ(picture("out.exr").values, picture("plain.exr").values);
  // The middle of the picture looks at (0.3, 0.3, 0) from 2 m away.
  const image::Layer depth = image::readLayer(path("out.exr"), "depth");
  EXPECT_EQ(depth.channels, std::vector<std::string>{"Z"});
  EXPECT_NEAR(*depth.image.pixel(32, 24), 2, 1e-5);
  EXPECT_TRUE(std::isinf(*depth.image.pixel(0, 0)));
  EXPECT_NEAR(image::readLayer(path("out.exr"), "normal").image.pixel(32, 24)[2], 1, 1e-4);
  EXPECT_EQ(*image::readLayer(path("out.exr"), "lights").image.pixel(32, 24), 1);
  EXPECT_EQ(picture("out.lights.png").width, 64);
  EXPECT_NE(contentOf(path("out.lights.png")).find("0 to 1"), std::string::npos);
  EXPECT_EQ(run({"compare", "out.exr", "plain.exr"}).exitCode, 0);
}

TEST_F(CommandLineGpu, NamesTheAovThatCannotBe) {
  expectErrors(
      folder.path(),
      {
          {{"render", "scene.gltf", "-o", "out.exr", "--aov", "depth,foo"},
           2,
           "--aov: \"foo\" is none of depth, normal, albedo, transmittance, lights, fragments, "
           "shadow-nodes"},
          {{"render", "scene.gltf", "-o", "out.exr", "--aov", ""}, 2, "--aov: \"\" is none of depth"},
          {{"render", "scene.gltf", "-o", "out.png", "--aov", "lights,depth"},
           2,
           "--aov depth: only an .exr holds it"},
          {{"render", "scene.gltf", "-o", "a.png", "-o", "a.lights.png", "--aov", "lights"},
           2,
           "a.lights.png: is named twice"},
          {{"render", "scene.gltf", "-o", "out.exr", "--reference", "--aov", "shadow-nodes"},
           2,
           "--aov shadow-nodes: is of lists that --reference does not have"},
      });
}

TEST_F(CommandLineRender, DrawsOnePixel) {
  render({"scene.gltf", "-o", "out.exr", "-o", "out.png"}, "1x1");
  EXPECT_EQ(picture("out.exr").values.size(), 3u);
  EXPECT_GT(sumOf(picture("out.exr")), 0);
}

TEST_F(CommandLineRender, ExposesPicturesAndNotRadiance) {
  render({"scene.gltf", "-o", "a.exr", "-o", "a.PNG"});
  render({"scene.gltf", "-o", "b.exr", "-o", "b.PNG", "--exposure", "-3"});
  EXPECT_EQ(picture("b.exr").values, picture("a.exr").values);
  EXPECT_LT(sumOf(picture("b.PNG")), sumOf(picture("a.PNG")));
}

TEST_F(CommandLineRender, TakesTheCameraThatIsNamed) {
  GltfBuilder gltf = wholeScene();
  for (Json& node : gltf.json["nodes"])
    if (node.value("name", "") == "the other") node["translation"] = {0.3, 0.3, 200};
  folder.write("two.gltf", gltf.text());
  render({"two.gltf", "-o", "near.exr"});
  render({"two.gltf", "-o", "far.exr", "--camera", "the other"});
  render({"two.gltf", "-o", "moved.exr", "--camera", "the other", "--look-from", "0.3", "0.3", "2"});
  EXPECT_LT(sumOf(picture("far.exr")), 0.1 * sumOf(picture("near.exr")));
  EXPECT_EQ(picture("moved.exr").values, picture("near.exr").values);
}

TEST_F(CommandLineRender, ReportsProgressOnStderr) {
  const Outcome outcome = run(draft({"scene.gltf", "-o", "out.png", "--repeat", "20"}, "8x8"));
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_EQ(outcome.out, "");
  const std::vector<std::string> shown = lines(outcome.err);
  ASSERT_EQ(shown.size(), 10u) << outcome.err;
  for (size_t i = 0; i < 10; ++i)
    EXPECT_TRUE(shown[i].starts_with("rendering: " + std::to_string(10 * (i + 1)) + "% ")) << shown[i];

  const Outcome bar = run(draft({"scene.gltf", "-o", "out.png"}, "8x8"), {.terminal = true});
  EXPECT_NE(bar.err.find("\rrendering [=========================] 100% "), std::string::npos) << bar.err;
  EXPECT_TRUE(bar.err.ends_with("s\r\n")) << bar.err;
}

// What `validate` once found out for the user decides nothing in tests, unless they ask for it.
TEST_F(CommandLineRender, RunsInTestsWithoutTheUsersVerdict) {
  const std::filesystem::path cache = path("cache of the user");
  const gl::DeviceNames& names = tests::testDevice()->names();
  setenv("XDG_CACHE_HOME", cache.c_str(), 1);
  lists::saveVerdict({{names.vendor, names.renderer, names.version}, {{"count", lists::Trust::Unsafe}}});
  const auto strategy = [&](const std::vector<std::string>& environment) {
    render({"scene.gltf", "-o", "out.exr", "--stats", "out.json"}, "8x8", {.environment = environment});
    return Json::parse(contentOf(path("out.json")))["lists"]["surfaces"]["strategy"];
  };
  EXPECT_EQ(strategy({}), "count");
  EXPECT_EQ(strategy({"XDG_CACHE_HOME=" + cache.string()}), "append");
  unsetenv("XDG_CACHE_HOME");
}

TEST_F(CommandLineRender, FitsShadowMapsIntoTheirMemoryOrSaysWhatTheyTake) {
  // A cube of maps: 12 bytes a texel at least.
  const Outcome outcome = run({"render", "scene.gltf", "-o", "out.exr", "--res", "64x48", "--quality", "high",
                               "--stats", "out.json", "--shadow-memory", "24K"});
  ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
  const Json figures = Json::parse(contentOf(path("out.json")));
  const Json& maps = figures["shadow_maps"];
  EXPECT_EQ(maps["budget_bytes"], 24 * 1024);
  EXPECT_EQ(maps["bytes"], 6 * 16 * 16 * 12);
  EXPECT_EQ(maps["lowered"], true);
  EXPECT_EQ(maps["lights"][0]["resolution"], 32);
  expectError(run(draft({"scene.gltf", "-o", "out.png", "-q", "--shadow-memory", "100K", "--shadow-res",
                         "512", "--shadow-error", "0"})),
              5, "deep shadow maps: take 46 times the 100.0 KiB that they may");
  expectError(
      run(draft({"scene.gltf", "-o", "out.png", "-q", "--pipeline", "interlaced", "--shadow-memory", "16K"})),
      5, "interlaced shadow maps: take 1.1 times the 16.0 KiB that they may");
  expectError(run(draft({"scene.gltf", "-o", "out.png", "-q", "--shadow-memory", "much"})), 2,
              "--shadow-memory");
}

TEST_F(CommandLineRender, ShapesPicturesAndKeepsRadiance) {
  render({"scene.gltf", "-o", "plain.exr", "-o", "plain.png"});
  const image::Image radiance = picture("plain.exr"), plain = picture("plain.png");
  struct Row {
    Arguments flags;
    std::string setting;  // that the picture says
  };
  for (const auto& [flags, setting] :
       {Row{{"--tonemap", "reinhard"}, "log_average_luminance"},
        Row{{"--bloom", "separable"}, "separable, strength 0.2"},
        Row{{"--bloom", "mipmap", "--bloom-strength", "9"}, "mipmap, strength 9"},
        Row{{"--aa", "edges"}, "anti_aliasing"},
        Row{{"--tonemap", "reinhard", "--white", "2"}, "white_luminance"}}) {
    SCOPED_TRACE(setting);
    Arguments arguments = {"scene.gltf", "-o", "out.exr", "-o", "out.png"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    render(arguments);
    EXPECT_EQ(picture("out.exr").values, radiance.values);
    EXPECT_THROW(image::readLayer(path("out.exr"), "depth"), base::Error);
    EXPECT_GT(image::compare(picture("out.png"), plain).relativeRmse, 1e-3);
    EXPECT_NE(contentOf(path("out.png")).find(setting), std::string::npos);
  }
}

TEST_F(CommandLineRender, ShapesPicturesOfTheReference) {
  render({"scene.gltf", "--reference", "-o", "plain.png"});
  render({"scene.gltf", "--reference", "-o", "out.exr", "-o", "out.png", "--aa", "edges"});
  EXPECT_THROW(image::readLayer(path("out.exr"), "depth"), base::Error);
  EXPECT_GT(image::compare(picture("out.png"), picture("plain.png")).relativeRmse, 1e-2);
}

TEST_F(CommandLineRender, ShapesPicturesOfEveryPipeline) {
  render({"scene.gltf", "-o", "plain.png"});
  for (const std::string& pipeline : pipelines::pipelineNames()) {
    render({"scene.gltf", "--pipeline", pipeline, "-o", "out.png", "--aa", "edges"});
    EXPECT_GT(image::compare(picture("out.png"), picture("plain.png")).relativeRmse, 1e-2) << pipeline;
  }
}

TEST_F(CommandLineGpu, PresetsGiveWayToFlags) {
  const auto plan = [&](const Arguments& flags) {
    Arguments arguments = {"render", "scene.gltf", "-n", "-q"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    const Outcome outcome = run(arguments, noEgl);
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    return outcome.out;
  };
  EXPECT_NE(plan({"--effects", "low"}).find("shadow maps 512 texels"), std::string::npos);
  EXPECT_NE(plan({"--effects", "high"}).find("shadow maps 2048 texels"), std::string::npos);
  EXPECT_NE(plan({"--effects", "high", "--shadow-res", "256"}).find("shadow maps 256 texels"),
            std::string::npos);
  EXPECT_NE(plan({"--quality", "draft", "--effects", "high"}).find("shadow maps 512 texels"),
            std::string::npos);
  expectError(run({"render", "scene.gltf", "-n", "--effects", "low", "--reference"}), 2, "--effects");
  expectError(run({"render", "scene.gltf", "-n", "--effects", "ultra"}), 2, "is none of low, medium, high");
}

TEST_F(CommandLineRender, PresetsSetEveryEffect) {
  render({"scene.gltf", "--ambient", "0.1", "-o", "out.png", "--effects", "low"});
  for (const char* setting : {"tone_map", "reinhard", "mipmap, strength 0.2", "edges", "quarter, radius"})
    EXPECT_NE(contentOf(path("out.png")).find(setting), std::string::npos) << setting;
  render({"scene.gltf", "--ambient", "0.1", "-o", "out.png", "--effects", "low", "--bloom", "separable",
          "--ssao", "off"});
  EXPECT_NE(contentOf(path("out.png")).find("separable, strength 0.2"), std::string::npos);
  EXPECT_EQ(contentOf(path("out.png")).find("radius"), std::string::npos);
  // An .exr alone has no picture to shape.
  render({"scene.gltf", "-o", "plain.exr", "--ssao", "off"});
  render({"scene.gltf", "-o", "out.exr", "--ssao", "off", "--effects", "low"});
  EXPECT_EQ(picture("out.exr").values, picture("plain.exr").values);
}

TEST_F(CommandLineRender, TimesPostProcessing) {
  render({"scene.gltf", "-o", "out.png", "--bloom", "mipmap", "--aa", "edges", "--stats", "out.json"});
  const Json figures = Json::parse(contentOf(path("out.json")));
  std::set<std::string> passes;
  for (const Json& pass : figures["frame"]["passes"]) passes.insert(pass["pass"]);
  for (const char* pass : {"post-processing", "post-processing/bloom", "post-processing/edges"})
    EXPECT_TRUE(passes.contains(pass)) << pass;
  EXPECT_EQ(figures["memory"]["peak_bytes_by_label"]["post-processed picture"], 2 * 64 * 48 * 16);
}

TEST_F(CommandLineRender, WritesFigures) {
  render({"scene.gltf", "-o", "out.png", "--stats", "out.json", "--repeat", "2"});
  const Json figures = Json::parse(contentOf(path("out.json")));
  EXPECT_EQ(figures["device"], tests::testDevice()->names().renderer);
  EXPECT_GT(figures["startup"]["seconds"], 0);
  EXPECT_EQ(figures["frame"]["seconds"].size(), 2u);
  EXPECT_EQ(figures["frame"]["triangles"], 1);
  EXPECT_EQ(figures["frame"]["cut_walks"], 0);
  ASSERT_FALSE(figures["frame"]["passes"].empty());
  for (const Json& pass : figures["frame"]["passes"]) {
    EXPECT_TRUE(pass["pass"].is_string());
    EXPECT_TRUE(pass["gpu_ms"].is_number());
    EXPECT_GT(pass["wall_ms"], 0) << pass;
    EXPECT_GE(pass["calls"], 1);
  }
  EXPECT_EQ(figures["lists"]["surfaces"]["cells"], 64 * 48);
  EXPECT_EQ(figures["lists"]["lights"]["cells"], 16 * 12);
  EXPECT_EQ(figures["shadow_maps"]["lights"].size(), 1u);
  EXPECT_GT(figures["memory"]["peak_bytes"], 64 * 48 * 36);
  EXPECT_GT(figures["memory"]["program_bytes"].size(), 5u);
}

TEST_F(CommandLineRender, SaysWhatAmbientOcclusionWasAndTook) {
  render({"scene.gltf", "-o", "out.png", "--stats", "out.json", "--ambient", "0.5,0.25,1", "--ssao", "half",
          "--ssao-radius", "0.25"});
  const Json figures = Json::parse(contentOf(path("out.json")));
  std::set<std::string> passes;
  for (const Json& pass : figures["frame"]["passes"]) passes.insert(pass["pass"]);
  for (const char* pass : {"occlusion G-buffer", "ambient occlusion", "occlusion blur"})
    EXPECT_TRUE(passes.contains(pass)) << pass;
  EXPECT_EQ(figures["memory"]["peak_bytes_by_label"]["ambient occlusion"], 2 * 32 * 24 * 16);
  const std::string picture = contentOf(path("out.png"));
  for (const char* part : {"0.5 0.25 1", "half, radius 0.25 m"})
    EXPECT_NE(picture.find(part), std::string::npos) << part;
}

TEST_F(CommandLineGpu, PlansWithoutOpenGl) {
  const auto before = listing(folder.path());
  const Outcome outcome = run(draft({"scene.gltf", "-n", "-o", "out.png", "--stats", "out.json"}), noEgl);
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_EQ(outcome.err, "");
  for (const char* part :
       {"scene    scene.gltf: instances 1, triangles 1, materials 1, lights 1\n", "camera   \"front\"\n",
        "64x48", "quality draft", "output   out.png\n", "output   out.json\n"})
    EXPECT_NE(outcome.out.find(part), std::string::npos) << outcome.out;
  EXPECT_EQ(listing(folder.path()), before);
}

TEST_F(CommandLineGpu, PlansWithTheSmokeThatIsThere) {
  try {
    volumes::writeVdb(path("smoke.vdb"), smoke());
  } catch (const base::Error& error) {
    GTEST_SKIP() << error.what();
  }
  const Outcome outcome = run({"render", "scene.gltf", "-n", "--volume", "smoke.vdb"});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("volume   smoke.vdb: grid \"density\", 8 x 8 x 8 voxels"), std::string::npos)
      << outcome.out;
  expectError(run({"render", "scene.gltf", "-n", "--volume", "no.vdb"}), 3, "no.vdb: cannot be read");
}

// ---- info ------------------------------------------------------------------------------------------------

TEST_F(CommandLineRender, ShowsTheDeviceOnOneScreen) {
  const Outcome outcome = run({"info"});
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_EQ(outcome.err, "");
  EXPECT_LE(lines(outcome.out).size(), 24u);
  for (const std::string& line : lines(outcome.out)) EXPECT_LE(line.size(), 100u) << line;
  EXPECT_NE(outcome.out.find(tests::testDevice()->names().renderer), std::string::npos) << outcome.out;
}

TEST_F(CommandLineRender, ShowsTheDeviceAsJson) {
  const Outcome outcome = run({"info", "--json"});
  EXPECT_EQ(outcome.exitCode, 0);
  EXPECT_EQ(outcome.err, "");
  const Json info = Json::parse(outcome.out);
  EXPECT_EQ(info["device"]["renderer"], tests::testDevice()->names().renderer);
  EXPECT_FALSE(info["devices"].empty());
  for (const Json& limit : info["limits"]) {
    EXPECT_TRUE(limit["value"].is_number());
    EXPECT_TRUE(limit["consequence"].is_string());
  }
  EXPECT_GE(info["limits"]["texture_2d_size"]["value"], 16384);  // what GL 4.3 asks for
}

TEST_F(CommandLineRender, SaysThatStdoutTookNothing) {
  const auto closed = [] { close(STDOUT_FILENO); };
  const auto full = [] { dup2(open("/dev/full", O_WRONLY), STDOUT_FILENO); };
  for (const std::function<void()>& inChild : {std::function<void()>(closed), std::function<void()>(full)}) {
    expectError(run({"info"}, {.inChild = inChild}), 3, "standard output");
    expectError(run({"info", "--json"}, {.inChild = inChild}), 3, "standard output");
    expectError(run({"render", "scene.gltf", "-n"}, {.inChild = inChild}), 3, "standard output");
  }
}

}  // namespace
}  // namespace sfumato::test
