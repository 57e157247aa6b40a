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
  expectErrors(folder().path(),
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
               });
}

TEST(CommandLine, TakesOnlyResolutionsThatAreOne) {
  for (const char* text : {"0x10",    "10x0",    "-5x5",      "5x-5",         "abc",
                           "99999x2", "2x16385", "640x480x3", "640",          "640x",
                           "x480",    "x",       "",          " 64x48",       "64x48 ",
                           "64X48",   "6.4x48",  "0x1p3x4",   "4294967297x1", "99999999999999999999x1"}) {
    const Outcome outcome = runProgram(folder().path(), {"render", "a.gltf", "--res", text});
    expectError(outcome, 2, "--res: \"" + std::string(text) + "\" is not WIDTHxHEIGHT");
  }
}

TEST(CommandLine, TakesOnlyNumbersInRange) {
  struct Number {
    std::string option;
    int count;
    std::vector<std::string> outside;
  };
  for (const Number& number : std::vector<Number>{
           {"--step", 1, {"0", "100.1", "-1"}},
           {"--fov", 1, {"0", "180", "-45"}},
           {"--exposure", 1, {"31", "-31"}},
           {"--volume-scale", 1, {"-1", "2e9"}},
           {"--volume-g", 1, {"1", "-1"}},
           {"--volume-albedo", 3, {"1.1", "-0.1"}},
           {"--look-from", 3, {"1e10", "-1e300"}},
           {"--look-at", 3, {"1e10", "1e400"}},
           {"--shadow-res", 1, {"31", "16385", "64.5", "1e3"}},
           {"--repeat", 1, {"0", "-1", "1001", "1.5"}},
           {"--samples", 1, {"0", "-1", "65", "1.5"}},
       }) {
    std::vector<std::string> texts = {"nan", "-nan", "inf", "-inf", "", "foo", "1 2", "1,5", "++1", "5e"};
    texts.insert(texts.end(), number.outside.begin(), number.outside.end());
    for (const std::string& text : texts) {
      Arguments arguments = {"render", "a.gltf", number.option};
      for (int i = 0; i < number.count; ++i) arguments.push_back(i == 0 ? text : "0.5");
      SCOPED_TRACE(number.option + " " + text);
      expectError(runProgram(folder().path(), arguments), 2, number.option + ": \"" + text + "\" is not a ");
    }
  }
}

TEST(CommandLine, ShowsHelpAndVersion) {
  for (const Arguments& arguments : std::vector<Arguments>{
           {"--help"}, {"-h"}, {"render", "--help"}, {"compare", "--help"}, {"info", "--help"}}) {
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
                                 {{"info"}, 4, "built without OpenGL"}});
}
#endif

}  // namespace
}  // namespace sfumato::test
