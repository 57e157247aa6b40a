#include "base/file.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "base/error.h"

namespace sfumato::base {

namespace fs = std::filesystem;

namespace {

constexpr int maxLinks = 40;  // as Linux has it

[[noreturn]] void failToWrite(const fs::path& path, const std::string& reason) {
  fail(ExitCode::Input, "{}: cannot be written: {}", path.string(), reason);
}

}  // namespace

std::vector<std::byte> readFile(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) fail(ExitCode::Input, "{}: is a folder, not a file", path.string());
  if (fs::is_other(path, ignored))
    fail(ExitCode::Input, "{}: is a device or a pipe: give a file", path.string());
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) fail(ExitCode::Input, "{}: cannot be read: {}", path.string(), std::strerror(errno));
  std::vector<std::byte> bytes(static_cast<size_t>(file.tellg()));
  file.seekg(0);
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!file) fail(ExitCode::Input, "{}: cannot be read to its end", path.string());
  return bytes;
}

void writeFile(const fs::path& path, std::string_view text) {
  PendingFile pending(path);
  std::ofstream file(pending.temporary(), std::ios::binary);
  file.write(text.data(), static_cast<std::streamsize>(text.size()));
  file.close();
  if (!file) failToWrite(path, std::strerror(errno));
  pending.rename();
}

PendingFile::PendingFile(fs::path path) : path_(std::move(path)), temporary_(path_) {
  std::error_code ignored;
  if (fs::is_other(path_, ignored)) return;
  for (int i = 0; i < maxLinks && fs::is_symlink(path_, ignored); ++i)
    path_ = path_.parent_path() / fs::read_symlink(path_, ignored);
  temporary_ = path_;
  temporary_.replace_filename(
      fmt::format(".{}.{}{}", path_.stem().string(), getpid(), path_.extension().string()));
}

PendingFile::~PendingFile() {
  std::error_code ignored;
  if (temporary_ != path_) fs::remove(temporary_, ignored);
}

void PendingFile::rename() {
  std::error_code error;
  if (temporary_ != path_) fs::rename(temporary_, path_, error);
  if (error) failToWrite(path_, error.message());
}

void checkWritable(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored))
    fail(ExitCode::Input, "{}: is a folder, not a file to write", path.string());
  if (path.has_parent_path() && !fs::exists(path.parent_path(), ignored))
    failToWrite(path, "there is no folder " + path.parent_path().string());
  const PendingFile pending(path);
  if (pending.temporary() == path) {  // opening a pipe would wait for its reader
    if (access(path.c_str(), W_OK) != 0) failToWrite(path, std::strerror(errno));
  } else if (!std::ofstream(pending.temporary())) {
    failToWrite(path, std::strerror(errno));
  }
}

}  // namespace sfumato::base
