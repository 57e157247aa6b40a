#include "gl/shader_source.h"

#include <gtest/gtest.h>

#include <fstream>

#include "base/error.h"
#include "tests/base/temporary_folder.h"

namespace sfumato::gl {
namespace {

namespace fs = std::filesystem;

class ShaderSourceFiles : public testing::Test {
 protected:
  ShaderSourceFiles() { fs::create_directories(folder_ / "a"); }
  void write(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }
  const test::TemporaryFolder own_{"shaders"};
  const fs::path& folder_ = own_.path();
};

TEST_F(ShaderSourceFiles, IncludesEachFileOnceAndKeepsPlaces) {
  write("a/main.comp", "first\n#include \"shaders/a/one.glsl\"\n#include \"shaders/a/two.glsl\"\nlast\n");
  write("a/one.glsl", "#include \"shaders/a/two.glsl\"\none\n");
  write("a/two.glsl", "two\n");
  const ShaderSource source = resolveShader("a/main.comp", {{"N", "3"}}, folder_);
  EXPECT_EQ(source.text,
            "#version 430 core\n#define N 3\n#line 1 0\nfirst\n#line 1 1\n#line 1 2\ntwo\n#line 2 "
            "1\none\n#line 3 0\n"
            "#line 4 0\nlast\n");
  EXPECT_EQ(source.files, (std::vector<std::string>{"a/main.comp", "a/one.glsl", "a/two.glsl"}));
}

TEST_F(ShaderSourceFiles, AnIncludeCycleEnds) {
  write("a/main.comp", "#include \"shaders/a/main.comp\"\nx\n");
  EXPECT_NE(resolveShader("a/main.comp", {}, folder_).text.find("x\n"), std::string::npos);
}

TEST_F(ShaderSourceFiles, TakesTheOverrideBeforeTheBuiltIn) {
  EXPECT_NE(resolveShader("lists/insert.glsl", {}, folder_).text.find("listStore"), std::string::npos);
  fs::create_directories(folder_ / "lists");
  write("lists/insert.glsl", "mine\n");
  EXPECT_EQ(resolveShader("lists/insert.glsl", {}, folder_).text, "#version 430 core\n#line 1 0\nmine\n");
}

TEST_F(ShaderSourceFiles, AMissingFileIsAUsageErrorThatNamesIt) {
  try {
    resolveShader("a/none.comp", {}, folder_);
    FAIL() << "no error";
  } catch (const base::Error& error) {
    EXPECT_EQ(error.exitCode, base::ExitCode::Usage);
    EXPECT_NE(std::string(error.what()).find("a/none.comp"), std::string::npos);
  }
}

TEST(ShaderLog, NamesFilesInBothCommonStyles) {
  const std::vector<std::string> files = {"main.comp", "lists/insert.glsl"};
  EXPECT_EQ(nameFilesInLog("1:14(2): error: x\n0(3) : error y", files),
            "lists/insert.glsl:14: error: x\nmain.comp:3 : error y");
  EXPECT_EQ(nameFilesInLog("7(3) : far", files), "7:3 : far");
}

}  // namespace
}  // namespace sfumato::gl
