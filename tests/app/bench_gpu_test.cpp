// `sfumato bench` as a stranger meets it, and whether it sees that a pipeline is wrong.
#include <set>

#include "image/image_file.h"
#include "tests/app/program.h"
#include "tests/gl/test_device.h"

namespace sfumato::test {
namespace {

namespace fs = std::filesystem;

class Bench : public testing::Test {
 protected:
  void SetUp() override { tests::needDevice(); }

  // With one timed frame, as times are not looked at.
  Outcome run(const std::string& kind, Arguments more) const {
    Arguments arguments = {"bench", kind, "--repeat", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram(folder.path(), arguments, {.seconds = 240});
  }

  Json json(const std::string& kind, Arguments more) const {
    more.push_back("--json");
    const Outcome outcome = run(kind, more);
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    return outcome.exitCode == 0 ? Json::parse(outcome.out) : Json();
  }

  TemporaryFolder folder{"bench"};
};

Json named(const Json& list, const std::string& key, const std::string& name) {
  for (const Json& one : list)
    if (one[key] == name) return one;
  ADD_FAILURE() << name << " is missing";
  return {};
}

double rmseAt(const Json& pipeline, int layers) {
  for (const Json& one : pipeline["layers"])
    if (one["from"] <= layers && layers <= one["to"]) return one["rmse"];
  ADD_FAILURE() << "no pixel has " << layers << " layers";
  return 0;
}

TEST_F(Bench, HoldsEveryPipelineAgainstTheReference) {
  const Json result = json("pipelines", {"--res", "64x36"});
  EXPECT_EQ(result["device"], tests::testDevice()->names().renderer);
  EXPECT_EQ(result["width"], 64);
  EXPECT_TRUE(result["exact"]["by"].get<std::string>().starts_with("CPU reference"));
  const Json lund = named(result["pipelines"], "name", "lund");
  EXPECT_LT(lund["rmse"], 0.02);
  std::set<std::string> names;
  for (const Json& one : result["pipelines"]) {
    SCOPED_TRACE(one["name"]);
    EXPECT_TRUE(names.insert(one["name"]).second);
    for (const char* text : {"paper", "cannot"}) EXPECT_NE(one[text], "");
    size_t pixels = 0;
    double squares = 0;
    for (const Json& layers : one["layers"]) {
      pixels += layers["pixels"].get<size_t>();
      squares += layers["pixels"].get<double>() * std::pow(layers["rmse"].get<double>(), 2);
    }
    EXPECT_EQ(pixels, 64u * 36u);
    EXPECT_NEAR(std::sqrt(squares / (64 * 36)), one["rmse"].get<double>(), 1e-6);
    EXPECT_GT(one["ms"], 0);
    EXPECT_EQ(one["ms_of_each"].size(), 1u);
    EXPECT_GE(one["bytes_per_pixel"].get<double>() * 64 * 36, 0.999 * one["frame_bytes"].get<double>());
    EXPECT_GT(one["frame_bytes"], 64 * 36 * 4);  // more than a byte for each channel
    int calls = 0;
    for (const Json& pass : one["calls"]) calls += pass["calls"].get<int>();
    EXPECT_EQ(one["passes"], calls);
    EXPECT_GT(calls, 3);
  }
}

// Those that keep all layers, under the same shadows, have the same error.
TEST_F(Bench, FindsTheExactOnesAlike) {
  const Json result =
      json("pipelines", {"--res", "48x27", "--pipelines", "lund,peeling,reentrant,stencil-routed"});
  const double lund = named(result["pipelines"], "name", "lund")["rmse"];
  for (const char* name : {"peeling", "reentrant", "stencil-routed"})
    EXPECT_NEAR(named(result["pipelines"], "name", name)["rmse"].get<double>(), lund, 0.01 * lund) << name;
}

TEST_F(Bench, TellsWhatAPipelineRefuses) {
  const Outcome outcome =
      run("pipelines", {"--res", "32x18", "--pipelines", "lund,forward", "--interlace", "full", "--json"});
  EXPECT_EQ(outcome.exitCode, 2) << outcome.err;
  const Json result = Json::parse(outcome.out);
  EXPECT_GT(named(result["pipelines"], "name", "lund")["ms"], 0);
  EXPECT_NE(named(result["pipelines"], "name", "forward")["refused"].get<std::string>().find("full"),
            std::string::npos);
}

// Of pixels that see no translucent surface all are right; behind four, one layer is not enough.
TEST_F(Bench, SeesThatOneLayerIsWrongWhereThereAreMore) {
  const Json result = json("pipelines", {"--res", "64x36", "--pipelines", "lund,peeling"});
  ASSERT_EQ(result["pipelines"].size(), 3u);
  const Json lund = named(result["pipelines"], "name", "lund");
  const Json all = named(result["pipelines"], "name", "peeling");
  const Json one = named(result["pipelines"], "name", "peeling, 1 layer");
  for (const int layers : {0, 1, 2, 4, 8})
    EXPECT_LT(rmseAt(all, layers), 1.5 * rmseAt(lund, layers)) << layers;
  for (const int layers : {0, 1}) EXPECT_LT(rmseAt(one, layers), 2 * rmseAt(lund, layers)) << layers;
  for (const int layers : {2, 4, 8}) EXPECT_GT(rmseAt(one, layers), 5 * rmseAt(lund, layers)) << layers;
  if (image::readsAndWritesImages()) {
    EXPECT_GT(one["perceptual_pixels"], lund["perceptual_pixels"]);
  }
}

TEST_F(Bench, TakesAScene) {
  folder.write("scene.gltf", glowingScene().text());
  const Json byReference = json("pipelines", {"scene.gltf", "--res", "32x24", "--pipelines", "lund"});
  const Json byLund =
      json("pipelines", {"scene.gltf", "--res", "32x24", "--pipelines", "lund", "--exact", "lund"});
  EXPECT_EQ(byReference["scene"], "scene.gltf");
  EXPECT_EQ(byReference["pipelines"].size(), 1u);
  EXPECT_LT(byReference["pipelines"][0]["rmse"], 0.01);
  EXPECT_LT(byReference["pipelines"][0]["relative_rmse"], 0.1);  // infinite where there is nothing to see
  EXPECT_TRUE(byLund["exact"]["by"].get<std::string>().starts_with("lund"));
}

TEST_F(Bench, WritesItsPictures) {
  if (!image::readsAndWritesImages()) GTEST_SKIP() << "this build writes no images";
  const Outcome outcome = run("pipelines", {"--res", "32x18", "--pipelines", "lund", "--report", "page"});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("lund (Lindbeck 2015): Cannot "), std::string::npos) << outcome.out;
  const std::string page = contentOf(folder.path() / "page" / "index.html");
  for (const char* file : {"exact.png", "lund.png", "lund_error.png"}) {
    EXPECT_NE(page.find("<img src=\"" + std::string(file) + "\""), std::string::npos) << file;
    EXPECT_TRUE(contentOf(folder.path() / "page" / file).starts_with("\x89PNG")) << file;
  }
}

TEST_F(Bench, SaysWhatIsWrong) {
  expectErrors(folder.path(), {{{"bench", "pipelines", "none.gltf"}, 3, "none.gltf"},
                               {{"bench", "pipelines", "--camera", "left"}, 2, "--camera: is for a scene"},
                               {{"bench", "pipelines", "--device", "none such"}, 4, "none such"},
                               {{"bench", "papers", "--device", "none such"}, 4, "none such"}});
  folder.write("taken", "");
  expectError(run("papers", {"--report", "taken"}), 3, "taken");
}

TEST_F(Bench, TellsThePapersFiguresAsRatios) {
  const Json result = json("papers", {"--paper", "metu", "--res", "64x36", "--lights", "2"});
  ASSERT_EQ(result["tables"].size(), 8u);
  const Json pipelines = named(result["tables"], "table", "4.4");
  ASSERT_EQ(pipelines["cells"].size(), 4u);
  const Json peeling = named(pipelines["cells"], "column", "peeling");
  EXPECT_EQ(peeling["row"], "2");
  EXPECT_EQ(peeling["paper_fps"], 197);
  EXPECT_NEAR(peeling["paper_ratio"].get<double>(), 197.0 / 318, 1e-12);
  EXPECT_EQ(peeling["opaque_triangles"], 38812);
  EXPECT_EQ(peeling["translucent_triangles"], 20832);
  EXPECT_EQ(peeling["width"], 64);
  EXPECT_EQ(peeling["shadow_texels"], 34);  // 1024 * 64 / 1920
  EXPECT_GT(peeling["ms"], 0);
  const Json interlaced = named(pipelines["cells"], "column", "interlaced");
  if (!interlaced["ms"].is_null()) {
    EXPECT_NEAR(peeling["ratio"].get<double>(), interlaced["ms"].get<double>() / peeling["ms"].get<double>(),
                1e-9);
  }
  const Json scenes = named(result["tables"], "table", "4.6");
  EXPECT_EQ(named(scenes["cells"], "column", "scene 2")["opaque_triangles"], 49210);
  EXPECT_EQ(named(scenes["cells"], "column", "scene 3")["translucent_triangles"], 0);
}

TEST_F(Bench, DrawsTheOtherPaperAtItsThreeSizes) {
  const Json result = json("papers", {"--paper", "cescg", "--res", "48x27"});
  ASSERT_EQ(result["tables"].size(), 1u);
  ASSERT_EQ(result["tables"][0]["cells"].size(), 30u);
  const int widths[] = {20, 32, 48}, heights[] = {15, 18, 27}, triangles[] = {287353, 201075, 11563};
  for (size_t i = 0; i < 30; ++i) {
    const Json& cell = result["tables"][0]["cells"][i];
    EXPECT_EQ(cell["width"], widths[i % 3]);
    EXPECT_EQ(cell["height"], heights[i % 3]);
    const std::string row = cell["row"];
    const int scene = row.starts_with("Sponza") ? 0 : row.starts_with("Dragon") ? 1 : 2;
    const bool whole = row.ends_with("SR") || scene == 1;
    const int drawn = cell["opaque_triangles"].get<int>() + cell["translucent_triangles"].get<int>();
    if (whole) {
      EXPECT_EQ(drawn, triangles[scene]) << row;
    } else {
      EXPECT_EQ(cell["translucent_triangles"], 0) << row;
    }
  }
}

}  // namespace
}  // namespace sfumato::test
