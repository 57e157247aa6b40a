#include "base/file.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "base/error.h"

namespace sfumato::base {

namespace fs = std::filesystem;

std::vector<std::byte> readFile(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) fail(ExitCode::Input, "{}: is a folder, not a file", path.string());
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
  if (!file) fail(ExitCode::Input, "{}: cannot be written: {}", path.string(), std::strerror(errno));
  pending.rename();
}

PendingFile::PendingFile(fs::path path) : path_(std::move(path)), temporary_(path_) {
  temporary_.replace_filename(
      fmt::format(".{}.{}{}", path_.stem().string(), getpid(), path_.extension().string()));
}

PendingFile::~PendingFile() {
  std::error_code ignored;
  fs::remove(temporary_, ignored);
}

void PendingFile::rename() {
  std::error_code error;
  fs::rename(temporary_, path_, error);
  if (error) fail(ExitCode::Input, "{}: cannot be written: {}", path_.string(), error.message());
}

void checkWritable(const fs::path& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored))
    fail(ExitCode::Input, "{}: is a folder, not a file to write", path.string());
  const PendingFile pending(path);
  if (!std::ofstream(pending.temporary()))
    fail(ExitCode::Input, "{}: cannot be written: {}", path.string(), std::strerror(errno));
}

}  // namespace sfumato::base
