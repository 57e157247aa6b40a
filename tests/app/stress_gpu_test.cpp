// `sfumato stress` as a stranger meets it, and what it sees when a shader loses nodes.
#include <sys/stat.h>

#include <csignal>
#include <thread>

#include "tests/app/program.h"
#include "tests/gl/test_device.h"

namespace sfumato::test {
namespace {

namespace fs = std::filesystem;

// A shader of the program, for a test to break.
std::string shader(const std::string& name) {
  const std::string text = contentOf(fs::path(SFUMATO_SOURCE_DIR) / "shaders" / name);
  EXPECT_FALSE(text.empty()) << name;
  return text;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

class Stress : public testing::Test {
 protected:
  void SetUp() override { tests::needDevice(); }

  // A small run of one load and all strategies, with more arguments.
  Outcome run(Arguments more, const Surroundings& surroundings = {}) const {
    Arguments arguments = {"stress", "--repeat", "1"};
    const auto add = [&](const std::string& option, const std::string& value) {
      if (std::find(more.begin(), more.end(), option) == more.end())
        arguments.insert(arguments.end(), {option, value});
    };
    add("--cells", "32x24");
    add("--layers", "6");
    add("--distribution", "hot-spot");
    add("--list-memory", "none");
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram(folder.path(), arguments, surroundings);
  }

  // Writes a broken shader into a folder of its own, and runs with it.
  Json runBroken(const std::string& name, const std::string& text, Arguments more = {}) const {
    fs::create_directories((folder.path() / "broken" / name).parent_path());
    folder.write("broken/" + name, text);
    more.insert(more.end(), {"--json", "--shader-dir", "broken"});
    const Outcome outcome = run(more);
    EXPECT_EQ(outcome.exitCode, 1) << outcome.err;
    return Json::parse(outcome.out);
  }

  TemporaryFolder folder{"stress_gpu"};
};

TEST_F(Stress, FindsEveryNodeOfEveryLoadAndStrategy) {
  const Outcome outcome = run({"--distribution", "uniform,hot-spot,one-cell,hair", "--json"});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err << outcome.out;
  const Json result = Json::parse(outcome.out);
  EXPECT_EQ(result["device"], tests::testDevice()->names().renderer);
  ASSERT_EQ(result["runs"].size(), 4u * 4u);
  for (const Json& one : result["runs"]) {
    const size_t nodes = one["distribution"] == "one-cell" ? 6 * 32 : 6 * 32 * 24;
    EXPECT_EQ(one["demanded"], nodes) << one;
    EXPECT_EQ(one["stored"], nodes) << one;
    EXPECT_EQ(one["lost"], 0) << one;
    EXPECT_EQ(one["fault"], "") << one;
    EXPECT_EQ(one["windows"], 1) << one;
    EXPECT_EQ(one["bytes_per_node"], 12) << one;
    EXPECT_GE(one["peak_bytes"], nodes * one["bytes_per_node"].get<size_t>()) << one;
    size_t cells = 0, shown = 0;
    for (const Json& lengths : one["lengths"]) {
      cells += lengths["cells"].get<size_t>();
      shown = lengths["to"];
    }
    EXPECT_EQ(cells, 32u * 24u) << one;
    EXPECT_GE(shown, one["longest"].get<size_t>()) << one;
    if (one["distribution"] == "uniform") {
      EXPECT_EQ(one["longest"], 6) << one;
    } else {
      EXPECT_GT(one["longest"], 20) << one;
    }
  }
}

TEST_F(Stress, KeepsABudgetAndLosesNothing) {
  const Outcome outcome = run({"--cells", "64x64", "--layers", "16", "--distribution", "uniform,hair",
                               "--list-memory", "25%,400K", "--json"});
  const Json result = Json::parse(outcome.out);
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  ASSERT_EQ(result["runs"].size(), 16u);
  for (const Json& one : result["runs"]) {
    EXPECT_EQ(one["lost"], 0) << one;
    EXPECT_EQ(one["stored"], 64 * 64 * 16) << one;
    EXPECT_GT(one["windows"], 1) << one;
    EXPECT_LE(one["peak_bytes"], one["budget_bytes"]) << one;
    EXPECT_LE(one["predicted_bytes"], one["budget_bytes"]) << one;
  }
}

TEST_F(Stress, SaysWhatABudgetWouldHaveToBe) {
  for (const char* strategy : {"spinlock", "lockfree", "append", "count"}) {
    const Outcome outcome = run(
        {"--distribution", "one-cell", "--layers", "512", "--list-memory", "64K", "--lists", strategy, "-q"});
    expectError(outcome, 5, "16384 nodes");
    EXPECT_NE(outcome.err.find(" KiB, the budget is 64.0 KiB"), std::string::npos) << outcome.err;
  }
  expectError(run({"--cells", "128x128", "--list-memory", "64K", "--on-overflow", "error", "-q"}), 5,
              "the budget is 64.0 KiB");
}

TEST_F(Stress, ReportsWhatWasBuiltWhereABudgetRefusesSome) {
  const Outcome outcome = run({"--distribution", "one-cell", "--layers", "4,512", "--list-memory", "64K",
                               "--lists", "count", "--json"});
  EXPECT_EQ(outcome.exitCode, 5) << outcome.err;
  const Json result = Json::parse(outcome.out);
  ASSERT_EQ(result["runs"].size(), 2u);
  EXPECT_FALSE(result["runs"][0].contains("refused"));
  EXPECT_TRUE(result["runs"][1].contains("refused"));
  EXPECT_EQ(result["refused_runs"], 1);
}

// ---- negative controls -----------------------------------------------------------------------------------

// The shader that all strategies build with, broken: node 17 is left out in one of its places.
TEST_F(Stress, SeesNodesThatTheContainerDrops) {
  const std::string insert = shader("lists/insert.glsl");
  const std::string unlinked = "    bool placed = listLink(cell, node, key, tries);";
  const std::string unscattered = "  if (listWants(cell)) {\n    uvec2 key = listKey(depth, id);";
  const std::string unlinkedNow =
      "    bool placed = true;\n    if (id != 17u) placed = listLink(cell, node, key, tries);";
  const std::string unscatteredNow =
      "  if (listWants(cell) && id != 17u) {\n    uvec2 key = listKey(depth, id);";

  // Without a word: the node is not even counted.
  const std::string uncounted = "bool listWants(uint cell) {";
  const Json unseen = runBroken("lists/insert.glsl",
                                replaced(insert, uncounted, uncounted + "\n  if (cell == 17u) return false;"),
                                {"--distribution", "uniform"});
  ASSERT_EQ(unseen["runs"].size(), 4u);
  for (const Json& one : unseen["runs"]) {
    EXPECT_EQ(one["lost"], 6) << one;
    EXPECT_EQ(one["rebuilt"], 0) << one;
  }
  // The container finds out, and builds with another strategy; that is a fault of the first one.
  const Json noticed = runBroken("lists/insert.glsl", replaced(insert, unlinked, unlinkedNow));
  for (const Json& one : noticed["runs"]) {
    EXPECT_EQ(one["lost"], 0) << one;
    EXPECT_EQ(one["rebuilt"], one["strategy"] == "count" ? 0 : 1) << one;
  }
  // No strategy is left.
  const std::string broken = replaced(replaced(insert, unlinked, unlinkedNow), unscattered, unscatteredNow);
  const Json hopeless = runBroken("lists/insert.glsl", broken);
  for (const Json& one : hopeless["runs"]) {
    EXPECT_GT(one["lost"], 0) << one;
    EXPECT_NE(one["fault"].get<std::string>().find("every strategy loses nodes"), std::string::npos) << one;
  }
}

TEST_F(Stress, SeesNodesThatAShaderDrops) {
  const std::string insert = shader("lists/stress/insert.comp");
  const Json result =
      runBroken("lists/stress/insert.comp",
                replaced(insert, "  uint cell;\n", "  if (number % 1000u == 17u) return;\n  uint cell;\n"));
  ASSERT_EQ(result["runs"].size(), 4u);
  for (const Json& one : result["runs"]) EXPECT_EQ(one["lost"], 5) << one;  // 17, 1017, ... of 4608
  EXPECT_EQ(result["lost"], 20);
}

TEST_F(Stress, SeesNodesThatStandTwiceOrElsewhereOrAreTorn) {
  struct Fault {
    std::string from, to, kind;
    int lost;
  };
  const std::string insert = shader("lists/stress/insert.comp");
  for (const Fault& fault : std::vector<Fault>{
           {"  uint cell;\n", "  if (number == 9u) number = 8u;\n  uint cell;\n", "twice", 1},
           {"  loadNode(number, cell, depth);\n",
            "  loadNode(number, cell, depth);\n  if (number == 9u) depth *= 0.5;\n", "foreign", 1},
           {"  listStore(", "  if (number == 9u) payload.words[0] ^= 1u;\n  listStore(", "torn", 0}}) {
    const Json result = runBroken("lists/stress/insert.comp", replaced(insert, fault.from, fault.to),
                                  {"--lists", "append,count"});
    ASSERT_EQ(result["runs"].size(), 2u);
    for (const Json& one : result["runs"]) {
      EXPECT_EQ(one[fault.kind], 1) << one;
      EXPECT_EQ(one["lost"], fault.lost) << one;
      EXPECT_NE(one["fault"], "") << one;
    }
  }
}

TEST_F(Stress, SeesLookupsThatReadOtherNodes) {
  const std::string lookup = shader("lists/stress/lookup.comp");
  const Json result = runBroken("lists/stress/lookup.comp",
                                replaced(lookup, "<= depth) {", "< depth * 0.99) {"), {"--lists", "count"});
  EXPECT_GT(result["runs"][0]["misread"], 0);
  EXPECT_EQ(result["runs"][0]["lost"], 0);
}

// ---- what it writes --------------------------------------------------------------------------------------

TEST_F(Stress, WritesOnePageThatNeedsNothingElse) {
  const Outcome outcome = run({"--report", "new/folder", "--cells", "64x64", "--list-memory", "none,50%"});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  if (outcome.err.find("built without Chart.js") != std::string::npos) GTEST_SKIP() << outcome.err;
  const fs::path page = folder.path() / "new/folder/index.html";
  const std::string text = contentOf(page);
  EXPECT_EQ(std::distance(fs::directory_iterator(page.parent_path()), {}), 1);
  EXPECT_GT(text.size(), 200000u);
  EXPECT_LT(text.size(), 1000000u);
  for (const char* part :
       {"Requested against capacity", "Heat map of list lengths", "Strategies side by side",
        "none lost, none twice", "hot-spot", "Chart.js v3", "</html>"})
    EXPECT_NE(text.find(part), std::string::npos) << part;
  for (const char* outside : {" src=", "<link", "@import", "url("})
    EXPECT_EQ(text.find(outside), std::string::npos) << outside;
}

TEST_F(Stress, SaysThatAReportCannotBeWritten) {
  folder.write("file", "");
  expectError(run({"--report", "file"}), 3, "file");
  expectError(run({"--report", "file/folder"}), 3, "file/folder");
  fs::create_directories(folder.path() / "taken/index.html");
  expectError(run({"--report", "taken"}), 3, "index.html");
}

TEST_F(Stress, ShowsATableWithALineForEachRun) {
  const Outcome outcome = run({});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  for (const char* strategy : {"\nspinlock  hot-spot  32x24", "\nlockfree  ", "\nappend  ", "\ncount  "})
    EXPECT_NE(outcome.out.find(strategy), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("\n4 runs, 18432 nodes: none lost"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.err.find("stress: 100%"), std::string::npos) << outcome.err;
  EXPECT_EQ(run({"-q"}).err, "");
}

TEST_F(Stress, MakesTheSameListsOfTheSameSeed) {
  const auto lengths = [&](const char* seed) {
    return Json::parse(run({"--seed", seed, "--lists", "append", "--json"}).out)["runs"][0]["lengths"];
  };
  EXPECT_EQ(lengths("3"), lengths("3"));
  EXPECT_NE(lengths("3"), lengths("4"));
}

// ---- soaking ---------------------------------------------------------------------------------------------

TEST_F(Stress, SoaksForItsTimeWithChangingLoads) {
  const Outcome outcome = run({"--minutes", "0.03", "--distribution", "uniform,hair,one-cell", "--json"});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err << outcome.out;
  const Json result = Json::parse(outcome.out);
  EXPECT_GE(result["seconds"], 1.8);
  ASSERT_GT(result["runs"].size(), 4u);
  std::set<std::string> loads;
  for (const Json& one : result["runs"]) {
    EXPECT_EQ(one["lost"], 0) << one;
    loads.insert(one["distribution"].dump() + one["width"].dump() + one["layers"].dump() +
                 one["budget_bytes"].dump());
  }
  EXPECT_GT(loads.size(), 4u);
}

TEST_F(Stress, EndsWithTheReportSoFarWhenInterrupted) {
  // The program is stopped by a process of its own group, as Ctrl-C does.
  const auto interrupt = [] {
    const pid_t program = getpid();
    if (fork() != 0) return;
    sleep(2);
    kill(program, SIGINT);
    _exit(0);
  };
  const Outcome outcome = run({"--minutes", "10", "--json"}, {.inChild = interrupt});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
  const Json result = Json::parse(outcome.out);
  EXPECT_EQ(result["interrupted"], true);
  EXPECT_GT(result["runs"].size(), 0u);
}

// ---- real scenes -----------------------------------------------------------------------------------------

// Two panes of tinted glass in front of each other, seen by a camera, and a light. A wall may stand between
// them.
std::string panes(bool wall = false) {
  GltfBuilder gltf;
  for (const float z : {0.f, -0.5f}) {
    const int positions = gltf.accessor<float>("VEC3", {-1, -1, z, 1, -1, z, 0, 1, z});
    gltf.meshNode({{"attributes", {{"POSITION", positions}}}, {"material", 0}});
  }
  if (wall) {
    const int positions = gltf.accessor<float>("VEC3", {-1, -1, -0.3, 1, -1, -0.3, 0, 1, -0.3});
    gltf.meshNode({{"attributes", {{"POSITION", positions}}}});
  }
  gltf.add("materials", {{"alphaMode", "BLEND"},
                         {"doubleSided", true},
                         {"pbrMetallicRoughness", {{"baseColorFactor", {0.8, 0.5, 0.3, 0.4}}}}});
  const int camera =
      gltf.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}});
  gltf.add("nodes", {{"camera", camera}, {"translation", {0, 0, 3}}});
  gltf.light({{"type", "point"}, {"intensity", 5}})["translation"] = {0.5, 0.5, 2};
  return gltf.text();
}

TEST_F(Stress, BuildsTheListsOfAScene) {
  folder.write("panes.gltf", panes());
  const Outcome outcome =
      runProgram(folder.path(),
                 {"stress", "panes.gltf", "--lights", "1..4", "--list-memory", "none,64K", "--lists",
                  "spinlock,count", "--res", "64x48", "--shadow-res", "32", "--json", "--report", "page"});
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err << outcome.out;
  const Json result = Json::parse(outcome.out);
  ASSERT_EQ(result["runs"].size(), 3u * 2u * 2u * 3u);  // 1, 2, 4 lights; budgets; strategies; kinds of lists
  std::map<int, size_t> lightNodes;
  for (const Json& one : result["runs"]) {
    EXPECT_EQ(one["lost"], 0) << one;
    EXPECT_EQ(one["different"], 0) << one;
    EXPECT_EQ(one["demanded"], one["stored"]) << one;
    if (one["lists"] == "surfaces") {
      EXPECT_EQ(one["longest"], 2) << one;
      EXPECT_EQ(one["cells"], 64 * 48) << one;
    }
    if (one["lists"] == "shadows") {
      EXPECT_GT(one["stored"], 0) << one;
    }
    if (one["lists"] == "lights") {
      const auto [known, isNew] = lightNodes.try_emplace(one["lights"], one["stored"]);
      EXPECT_EQ(known->second, one["stored"]) << one;  // of every strategy and budget
    }
    if (!one["budget_bytes"].is_null()) {
      EXPECT_LE(one["peak_bytes"], one["budget_bytes"]) << one;
    }
  }
  ASSERT_EQ(lightNodes.size(), 3u);
  EXPECT_EQ(lightNodes.begin()->first, 2);  // the scene's own, and one
  EXPECT_LT(lightNodes.at(2), lightNodes.at(5));
}

TEST_F(Stress, ShowsTheListsOfASceneAsThoseOfALoad) {
  folder.write("panes.gltf", panes());
  const Arguments arguments = {"stress", "panes.gltf",   "--lists", "count",  "--res",    "64x48",
                               "-q",     "--shadow-res", "256",     "--json", "--report", "page"};
  const Outcome outcome = runProgram(folder.path(), arguments);
  EXPECT_EQ(outcome.exitCode, 0) << outcome.err << outcome.out;
  const Json result = Json::parse(outcome.out);
  for (const Json& one : result["runs"]) {
    size_t cells = 0;
    for (const Json& lengths : one["lengths"]) cells += lengths["cells"].get<size_t>();
    EXPECT_EQ(cells, one["cells"]) << one;
    EXPECT_GT(one["lookups_per_second"], 0) << one;
    // Of the shapes alone; lights are predicted where nothing is seen, too.
    const auto predicted = one["nodes_from_bounds"].get<double>(), stored = one["stored"].get<double>();
    EXPECT_GE(predicted, 0.97 * stored) << one;
    EXPECT_LE(predicted, (one["lists"] == "lights" ? 6 : 1.03) * stored) << one;
    EXPECT_GT(one["bytes_from_bounds"], one["nodes_from_bounds"]) << one;
  }
  const std::string page = contentOf(folder.path() / "page/index.html");
  for (const char* part : {"Heat map of list lengths: surfaces", "Heat map of list lengths: lights",
                           "Heat map of list lengths: shadows", "List lengths", "Lookups"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
}

// Each fault of a shader that builds a scene's lists is found, in each of them.
TEST_F(Stress, SeesWhatIsWrongWithTheListsOfAScene) {
  folder.write("panes.gltf", panes());
  struct Fault {
    std::string file, from, to, kind;
  };
  const std::string insert = "lists/insert.glsl";
  for (const Fault& fault : std::vector<Fault>{
           {insert, "bool listWants(uint cell) {",
            "bool listWants(uint cell) {\n  if (cell % 13u == 9u) return false;", "lost"},
           {insert, "    uvec2 key = listKey(depth, id);\n    uint node = atomicAdd(",
            "    uvec2 key = listKey(depth + 1.0, id);\n    uint node = atomicAdd(", "foreign"},
           {insert, "    uvec2 key = listKey(depth, id);\n    uint node = atomicAdd(",
            "    uvec2 key = listKey(depth, id & ~7u);\n    uint node = atomicAdd(", "foreign"},
           {"lists/sort.comp", "void main() {", "void main() {\n  if (true) return;", "unsorted"},
           {"lists/stress/lookup.comp", "<= depth) {", "< depth * 0.9) {", "misread"}}) {
    SCOPED_TRACE(fault.to);
    fs::remove_all(folder.path() / "broken");
    fs::create_directories((folder.path() / "broken" / fault.file).parent_path());
    folder.write("broken/" + fault.file, replaced(shader(fault.file), fault.from, fault.to));
    const Outcome outcome = runProgram(
        folder.path(), {"stress", "panes.gltf", "--lists", "count", "--res", "64x48", "-q", "--shadow-res",
                        "32", "--json", "--lights", "64..64", "--shader-dir", "broken"});
    EXPECT_EQ(outcome.exitCode, 1) << outcome.err;
    const Json result = Json::parse(outcome.out);
    ASSERT_EQ(result["runs"].size(), 3u);
    for (const Json& one : result["runs"]) {
      EXPECT_GT(one[fault.kind], 0) << one;
      EXPECT_NE(one["fault"], "") << one;
    }
  }
}

// A wall stands between the panes: what it hides is stored nowhere, unless a shader is broken.
TEST_F(Stress, SeesSurfacesThatAreStoredBehindAWall) {
  folder.write("walled.gltf", panes(true));
  const auto hidden = [&](const std::string& lists, const Arguments& more) {
    Arguments arguments = {"stress", "walled.gltf", "--lists",      "count", "--res",
                           "64x48",  "-q",          "--shadow-res", "32",    "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = runProgram(folder.path(), arguments);
    size_t nodes = 0;
    const Json result = Json::parse(outcome.out);
    for (const Json& one : result["runs"])
      if (one["lists"] == lists) nodes = one["hidden"];
    EXPECT_EQ(outcome.exitCode, nodes > 0 ? 1 : 0) << outcome.out;
    return nodes;
  };
  EXPECT_EQ(hidden("surfaces", {}), 0u);
  EXPECT_EQ(hidden("shadows", {}), 0u);
  fs::create_directories(folder.path() / "broken/pipelines");
  fs::create_directories(folder.path() / "broken/deepshadow");
  folder.write("broken/pipelines/translucent.frag",
               replaced(shader("pipelines/translucent.frag"), "depth < opaque && ", ""));
  folder.write("broken/deepshadow/listed.frag",
               replaced(shader("deepshadow/listed.frag"), "depth < texelFetch(opaqueDepth, texel, 0).r",
                        "depth < 1e30"));
  EXPECT_GT(hidden("surfaces", {"--shader-dir", "broken"}), 300u);
  EXPECT_GT(hidden("shadows", {"--shader-dir", "broken"}), 10u);
  // Four samples a pixel as well.
  EXPECT_EQ(hidden("surfaces", {"--quality", "medium"}), 0u);
  EXPECT_GT(hidden("surfaces", {"--quality", "medium", "--shader-dir", "broken"}), 300u);
}

TEST_F(Stress, SaysWhatIsWrongWithAScene) {
  folder.write("panes.gltf", panes());
  expectErrors(folder.path(),
               {{{"stress", "none.gltf"}, 3, "none.gltf"},
                {{"stress", "panes.gltf", "--minutes", "1"}, 2, "--minutes: is for synthetic loads"},
                {{"stress", "panes.gltf", "--camera", "side"}, 2, "no camera \"side\""}});
}

TEST_F(Stress, NeedsOpenGl) {
  expectError(run({}, {.environment = {"__EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent.json"}}), 4,
              "no usable OpenGL 4.3");
}

}  // namespace
}  // namespace sfumato::test
