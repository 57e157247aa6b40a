#include "base/file.h"

#include <gtest/gtest.h>

#include <fstream>

#include "base/error.h"
#include "tests/base/temporary_folder.h"

namespace sfumato::base {
namespace {

namespace fs = std::filesystem;

class File : public testing::Test {
 protected:
  // The names in the folder.
  std::vector<std::string> names() const {
    std::vector<std::string> found;
    for (const auto& entry : fs::directory_iterator(folder))
      found.push_back(entry.path().filename().string());
    return found;
  }

  static std::string textOf(const fs::path& path) {
    const std::vector<std::byte> bytes = readFile(path);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }

  template <typename Act>
  static void expectInputError(const Act& act) {
    try {
      act();
      ADD_FAILURE() << "nothing was thrown";
    } catch (const Error& error) {
      EXPECT_EQ(error.exitCode, ExitCode::Input) << error.what();
    }
  }

  const test::TemporaryFolder own{"file"};
  const fs::path& folder = own.path();
};

TEST_F(File, ReadsWhatWasWrittenByteForByte) {
  const std::string text("a\0b\r\n\xff", 6);
  writeFile(folder / "a.bin", text);
  EXPECT_EQ(textOf(folder / "a.bin"), text);
  writeFile(folder / "a.bin", "");
  EXPECT_TRUE(readFile(folder / "a.bin").empty());
  EXPECT_EQ(names(), std::vector<std::string>{"a.bin"});
}

TEST_F(File, RefusesToReadWhatIsNoFile) {
  expectInputError([&] { readFile(folder / "missing"); });
  expectInputError([&] { readFile(folder); });
}

TEST_F(File, KeepsTheOldFileWhenAWriteIsGivenUp) {
  writeFile(folder / "a.txt", "old");
  {
    const PendingFile pending(folder / "a.txt");
    EXPECT_EQ(pending.temporary().parent_path(), folder);
    EXPECT_EQ(pending.temporary().extension(), ".txt");
    std::ofstream(pending.temporary()) << "half of the new";
    EXPECT_EQ(names().size(), 2u);
  }
  EXPECT_EQ(names(), std::vector<std::string>{"a.txt"});
  EXPECT_EQ(textOf(folder / "a.txt"), "old");
}

TEST_F(File, ReplacesTheOldFileWhenAWriteIsDone) {
  writeFile(folder / "a.txt", "old");
  PendingFile pending(folder / "a.txt");
  std::ofstream(pending.temporary()) << "new";
  pending.rename();
  EXPECT_EQ(names(), std::vector<std::string>{"a.txt"});
  EXPECT_EQ(textOf(folder / "a.txt"), "new");
}

TEST_F(File, RefusesToWriteWhereNothingCanBe) {
  expectInputError([&] { writeFile(folder / "no" / "such" / "folder.txt", "text"); });
  fs::create_directory(folder / "taken");
  expectInputError([&] { writeFile(folder / "taken", "text"); });
  EXPECT_EQ(names(), std::vector<std::string>{"taken"});
}

TEST_F(File, SaysBeforeTheWorkWhetherAFileCanBeWritten) {
  checkWritable(folder / "a.txt");
  EXPECT_TRUE(names().empty());
  writeFile(folder / "a.txt", "old");
  checkWritable(folder / "a.txt");
  EXPECT_EQ(textOf(folder / "a.txt"), "old");
  expectInputError([&] { checkWritable(folder); });
  expectInputError([&] { checkWritable(folder / "no" / "a.txt"); });
}

}  // namespace
}  // namespace sfumato::base
