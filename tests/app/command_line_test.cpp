// What the program says before it needs a scene or OpenGL.
#include <gtest/gtest.h>

#include "tests/app/program.h"

namespace sfumato::test {
namespace {

const TemporaryFolder& folder() {
  static const TemporaryFolder instance("command_line");
  return instance;
}

TEST(CommandLine, NamesTheArgumentThatIsWrong) {
  expectErrors(
      folder().path(),
      {
          {{}, 2, "no command"},
          {{"frobnicate"}, 2, "frobnicate: no such command"},
          {{"--frob"}, 2, "--frob: no such option"},
          {{"info", "--frob"}, 2, "--frob: no such option: see `sfumato info --help`"},
          {{"info", "more"}, 2, "more: is one argument too many"},
          {{"info", "--shader-dir", "nowhere"}, 2, "--shader-dir: \"nowhere\" is not a folder"},
          {{"render", "--frob"}, 2, "--frob: no such option: see `sfumato render --help`"},
          {{"render", "a.gltf", "b.gltf"}, 2, "b.gltf: is one argument too many"},
          {{"render", ""}, 2, "SCENE: \"\" is no file"},
          {{"render", "a.gltf", "-o"}, 2, "--output: takes FILE"},
          {{"render", "a.gltf", "-o", ""}, 2, "--output: \"\" is no file"},
          {{"render", "a.gltf", "--stats", ""}, 2, "--stats: \"\" is no file"},
          {{"render", "a.gltf", "--volume", ""}, 2, "--volume: \"\" is no file"},
          {{"render", "a.gltf", "--res"}, 2, "--res: takes WxH"},
          {{"render", "a.gltf", "--res", "8x8", "--res", "9x9"}, 2, "--res: takes WxH, once"},
          {{"render", "a.gltf", "--look-at", "1", "2"}, 2, "--look-at: takes X Y Z"},
          {{"render", "a.gltf", "--quality", "foo"}, 2, "--quality: \"foo\" is none of draft, "},
          {{"render", "a.gltf", "--pipeline", "foo"}, 2, "--pipeline: \"foo\" is none of lund, "},
          {{"render", "a.gltf", "--refraction", "0.1", "-o", "a.exr"},
           2,
           "--refraction: --pipeline lund has no"},
          {{"render", "a.gltf", "--pipeline", "peeling", "--aov", "depth", "-o", "a.exr"},
           2,
           "--aov: --pipeline"},
          {{"render", "a.gltf", "--tonemap", "foo"}, 2, "--tonemap: \"foo\" is none of neutral, "},
          {{"render", "a.gltf", "--bloom", "on"}, 2, "--bloom: \"on\" is none of off, separable, "},
          {{"render", "a.gltf", "--aa", "4"}, 2, "--aa: \"4\" is none of off, edges"},
          {{"render", "a.gltf", "--aa"}, 2, "--aa: takes NAME"},
          {{"bench"}, 2, "name pipelines or papers: see `sfumato bench --help`"},
          {{"bench", "--frob"}, 2, "--frob: no such option: see `sfumato bench --help`"},
          {{"bench", "shapes"}, 2, "shapes: is one argument too many"},
          {{"bench", "pipelines", "--frob"}, 2, "see `sfumato bench pipelines --help`"},
          {{"bench", "pipelines", "--res"}, 2, "--res: takes WxH, once: see `sfumato bench pipelines"},
          {{"bench", "pipelines", "--pipelines", "foo"}, 2, "--pipelines: \"foo\" is none of lund"},
          {{"bench", "pipelines", "--exact", "foo"}, 2, "--exact: \"foo\" is none of cpu, lund"},
          {{"bench", "pipelines", "--repeat", "0"}, 2, "--repeat: \"0\" is not a whole number"},
          {{"bench", "papers", "a.gltf"}, 2, "a.gltf: is one argument too many"},
          {{"bench", "papers", "--paper", "foo"}, 2, "--paper: \"foo\" is none of metu, cescg"},
          {{"bench", "papers", "--lights", "2..65"}, 2, "--lights: \"2..65\" is not a range"},
      });
}

TEST(CommandLine, TakesOnlyResolutionsThatAreOne) {
  for (const char* text : {"0x10", "10x0", "-5x5", "abc", "99999x2", "2x16385", "640x480x3", "640x", "x480",
                           "", " 64x48", "64X48", "6.4x48", "4294967297x1"}) {
    const Outcome outcome = runProgram(folder().path(), {"render", "a.gltf", "--res", text});
    expectError(outcome, 2, "--res: \"" + std::string(text) + "\" is not WIDTHxHEIGHT");
  }
}

TEST(CommandLine, TakesOnlyNumbersInRange) {
  struct Row {
    std::string option;
    int count;
    Arguments wrong;
  };
  for (const Row& row : std::vector<Row>{
           {"--step", 1, {"0", "100.1", "nan", "-nan", "inf", "", "foo", "1 2", "1,5", "++1", "5e"}},
           {"--fov", 1, {"-45", "180", "nan"}},
           {"--exposure", 1, {"31", "nan"}},
           {"--white", 1, {"0", "-1", "1e10", "nan"}},
           {"--bloom-strength", 1, {"-0.1", "10.1", "nan"}},
           {"--volume-scale", 1, {"-1", "nan"}},
           {"--volume-g", 1, {"1", "nan"}},
           {"--volume-extinction", 3, {"-1", "1e7", "nan"}},
           {"--fire-kelvin", 1, {"0", "nan", "1e7"}},
           {"--fire-strength", 1, {"-1", "nan"}},
           {"--fire-lights", 1, {"-1", "65", "1.5"}},
           {"--volume-albedo", 3, {"1.1", "nan"}},
           {"--look-from", 3, {"-1e300", "nan"}},
           {"--look-at", 3, {"1e400", "nan"}},
           {"--shadow-res", 1, {"31", "64.5", "1e3", "nan"}},
           {"--shadow-error", 1, {"-0.1", "0.51", "nan", "foo"}},
           {"--repeat", 1, {"0", "1001"}},
           {"--ssao-radius", 1, {"0", "nan", "-1", "1e7"}},
           {"--samples", 1, {"0", "65", "1.5", "nan"}},
       }) {
    for (const std::string& text : row.wrong) {
      Arguments arguments = {"render", "a.gltf", row.option, text};
      arguments.resize(static_cast<size_t>(3 + row.count), "0.5");
      SCOPED_TRACE(row.option + " " + text);
      expectError(runProgram(folder().path(), arguments), 2, row.option + ": \"" + text + "\" is not a ");
    }
  }
}

TEST(CommandLine, TakesOnlyAmbientLightThatCanBe) {
  for (const char* text :
       {"", "-1", "1,2", "1,2,3,4", "1,2,", ",,", "1 2 3", "nan", "0,0,-0.1", "1e7", "red"})
    expectError(runProgram(folder().path(), {"render", "a.gltf", "--ambient", text}), 2,
                "--ambient: \"" + std::string(text) + "\" is not a colour");
  expectErrors(folder().path(),
               {
                   {{"render", "a.gltf", "--ssao", "tiny"}, 2, "--ssao: \"tiny\" is none of off, full, "},
                   {{"render", "a.gltf", "--ssao", "half", "--reference"}, 2, "--reference excludes --ssao"},
                   {{"render", "a.gltf", "--ssao-radius", "1"}, 2, "--ssao-radius requires --ssao"},
               });
}

TEST(CommandLine, ShowsHelpAndVersion) {
  for (const Arguments& arguments : std::vector<Arguments>{{"--help"},
                                                           {"-h"},
                                                           {"render", "--help"},
                                                           {"compare", "--help"},
                                                           {"stress", "--help"},
                                                           {"bench", "--help"},
                                                           {"bench", "pipelines", "--help"},
                                                           {"bench", "papers", "--help"},
                                                           {"info", "--help"}}) {
    const Outcome outcome = runProgram(folder().path(), arguments);
    EXPECT_EQ(outcome.exitCode, 0);
    EXPECT_EQ(outcome.err, "");
    EXPECT_NE(outcome.out.find("Usage: sfumato "), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find("  -q,--quiet "), std::string::npos) << outcome.out;
    EXPECT_EQ(outcome.out.find("\n\n\n"), std::string::npos) << outcome.out;
    for (const std::string& line : lines(outcome.out)) EXPECT_LE(line.size(), 100u) << line;
  }
  const Outcome version = runProgram(folder().path(), {"--version"});
  EXPECT_EQ(version.exitCode, 0);
  EXPECT_EQ(version.err, "");
  EXPECT_TRUE(version.out.starts_with("sfumato ")) << version.out;
  EXPECT_EQ(lines(version.out).size(), 1u);
}

TEST(CommandLine, SaysThatStdoutTookNothing) {
  const auto closed = [] { close(STDOUT_FILENO); };
  const auto full = [] { dup2(open("/dev/full", O_WRONLY), STDOUT_FILENO); };
  for (const std::function<void()>& inChild : {std::function<void()>(closed), std::function<void()>(full)})
    for (const char* argument : {"--help", "--version"})
      expectError(runProgram(folder().path(), {argument}, {.inChild = inChild}), 3, "standard output");
}

TEST(CommandLine, SurvivesClosedStderr) {
  const Outcome outcome =
      runProgram(folder().path(), {"frobnicate"}, {.inChild = [] { close(STDERR_FILENO); }});
  EXPECT_EQ(outcome.exitCode, 2);
  EXPECT_EQ(outcome.out + outcome.err, "");
}

#ifndef SFUMATO_GL
TEST(CommandLine, SaysThatItWasBuiltWithoutOpenGl) {
  folder().write("empty.gltf", GltfBuilder().text());
  expectErrors(folder().path(), {{{"render", "empty.gltf", "-q", "-o", "a.png"}, 4, "built without OpenGL"},
                                 {{"bench", "papers"}, 4, "built without OpenGL"},
                                 {{"info"}, 4, "built without OpenGL"}});
}
#endif

}  // namespace
}  // namespace sfumato::test
