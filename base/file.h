// Files as bytes, and outputs that are never half written.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace sfumato::base {

// The whole file. Throws Input when it is missing, unreadable, or not a file (a folder, a pipe, a device).
std::vector<std::byte> readFile(const std::filesystem::path& path);

// Writes text beside `path`, then renames it; a device or a pipe is written to directly. Throws Input when
// that fails; a file at `path` is then as it was.
void writeFile(const std::filesystem::path& path, std::string_view text);

// A name beside `path` to write to (same folder and ending); rename() makes it the file, and a destructor
// without rename() removes it. A symbolic link stays, and the file that it names is replaced; a device or a
// pipe is never replaced: its temporary name is its own.
class PendingFile {
 public:
  explicit PendingFile(std::filesystem::path path);
  ~PendingFile();
  PendingFile(const PendingFile&) = delete;
  PendingFile& operator=(const PendingFile&) = delete;

  const std::filesystem::path& temporary() const { return temporary_; }
  void rename();  // throws Input when the file system refuses

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_;  // path_ itself for a device or a pipe
};

// Throws Input unless a file can be written at `path`: for a check before long work.
void checkWritable(const std::filesystem::path& path);

}  // namespace sfumato::base
