// Who may include whom: DESIGN.md's floors, and the one file that each heavy library is included in.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace sfumato {
namespace {

namespace fs = std::filesystem;
using Complaints = std::vector<std::string>;

const std::vector<std::string> rooms = {"base",   "image",      "scene",   "volumes",   "gl",  "lists",
                                        "lights", "deepshadow", "shaders", "pipelines", "app", "demos"};

std::string roomOf(const std::string& path) {
  return path.substr(0, path.find('/'));
}

bool isGpuHalf(const std::string& path) {
  return std::regex_search(path, std::regex(R"(_gpu\.(h|cpp)$)"));
}

// The floor of a source file, by its path from the root; a file includes its own folder and lower floors.
std::optional<int> floorOf(const std::string& path) {
  const std::string room = roomOf(path);
  if (room == "shaders") return 0;
  if (isGpuHalf(path) && (room == "lists" || room == "volumes")) return 4;
  if (isGpuHalf(path) && (room == "lights" || room == "deepshadow")) return 5;
  static const std::map<std::string, int> floors = {
      {"base", 0},  {"image", 1}, {"volumes", 1},   {"lights", 1}, {"lists", 1}, {"deepshadow", 1},
      {"scene", 2}, {"gl", 3},    {"pipelines", 6}, {"app", 7},    {"demos", 7}};
  const auto found = floors.find(room);
  if (found == floors.end()) return std::nullopt;
  return found->second;
}

// A file is allowed its own folder, but there its CPU half does not include its GPU half.
bool mayInclude(const std::string& path, const std::string& included) {
  const std::optional<int> own = floorOf(path), other = floorOf(included);
  if (!own || !other) return false;
  if (roomOf(path) == roomOf(included)) return *other <= *own;
  return *other < *own;
}

struct Source {
  std::string path;  // from the root
  std::string text;
};

std::vector<Source> allSources() {
  std::vector<Source> sources;
  const fs::path root = SFUMATO_SOURCE_DIR;
  for (const std::string& room : rooms) {
    const fs::path folder = room == "shaders" ? root / "shaders" / "shared" : root / room;
    if (!fs::exists(folder)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      const fs::path& file = entry.path();
      if (file.extension() != ".h" && file.extension() != ".cpp") continue;
      std::ifstream stream(file);
      sources.push_back(
          {file.lexically_relative(root).generic_string(), {std::istreambuf_iterator<char>(stream), {}}});
    }
  }
  return sources;
}

// Calls visit(number, line) for each line, from 1.
template <typename Visit>
void forEachLine(const std::string& text, const Visit& visit) {
  std::istringstream stream(text);
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) visit(number, line);
}

std::optional<std::string> includeOf(const std::string& line) {
  static const std::regex pattern(R"(^\s*#\s*include\s*["<]([^">]+)[">])");
  std::smatch match;
  if (!std::regex_search(line, match, pattern)) return std::nullopt;
  return match[1].str();
}

std::string place(const Source& source, int line) {
  return source.path + ":" + std::to_string(line) + ": ";
}

Complaints checkFloors(const Source& source) {
  Complaints complaints;
  forEachLine(source.text, [&](int number, const std::string& line) {
    const auto included = includeOf(line);
    if (!included || std::find(rooms.begin(), rooms.end(), roomOf(*included)) == rooms.end()) return;
    if (included->find('/') != std::string::npos && !mayInclude(source.path, *included))
      complaints.push_back(place(source, number) + "includes " + *included + ", which stands higher");
  });
  return complaints;
}

// A library that few files may include: by the pattern of its headers, and of the files that may.
struct Library {
  const char* name;
  const char* headers;
  const char* allowed;
};

constexpr Library libraries[] = {
    {"OpenGL", R"(^(epoxy|GL|GLES\d?|EGL|KHR)/)", R"(^gl/)"},
    {"OpenImageIO", R"(^OpenImageIO/)", R"(^image/image_file\.cpp$)"},
    {"OpenVDB", R"(^openvdb/)", R"(^volumes/vdb_file\.cpp$)"},
    {"tinygltf", R"((^|/)tiny_gltf\.h$)", R"(^scene/gltf\.cpp$)"},
};

Complaints checkLibraries(const Source& source) {
  Complaints complaints;
  forEachLine(source.text, [&](int number, const std::string& line) {
    const auto included = includeOf(line);
    if (!included) return;
    for (const Library& library : libraries)
      if (std::regex_search(*included, std::regex(library.headers)) &&
          !std::regex_search(source.path, std::regex(library.allowed)))
        complaints.push_back(place(source, number) + "includes " + *included + " of " + library.name +
                             ", which is for " + library.allowed);
  });
  return complaints;
}

Complaints checkGlCalls(const Source& source) {
  Complaints complaints;
  if (roomOf(source.path) == "gl") return complaints;
  static const std::regex call(R"(\b(gl|egl)[A-Z]\w*\s*\()");
  forEachLine(source.text, [&](int number, const std::string& line) {
    std::smatch match;
    const std::string code = line.substr(0, line.find("//"));
    if (std::regex_search(code, match, call))
      complaints.push_back(place(source, number) + "calls " + match.str() + "), which is for gl/");
  });
  return complaints;
}

// The reference has nothing in common with what it judges.
Complaints checkReference(const Source& source) {
  Complaints complaints;
  if (!source.path.starts_with("pipelines/reference")) return complaints;
  forEachLine(source.text, [&](int number, const std::string& line) {
    const auto included = includeOf(line);
    if (included && (isGpuHalf(*included) || roomOf(*included) == "gl" || roomOf(*included) == "shaders"))
      complaints.push_back(place(source, number) + "includes " + *included + ", which the reference judges");
  });
  return complaints;
}

void expectNoComplaint(Complaints (*check)(const Source&)) {
  const std::vector<Source> sources = allSources();
  EXPECT_GT(sources.size(), 20u);
  for (const Source& source : sources)
    for (const std::string& complaint : check(source)) ADD_FAILURE() << complaint;
}

TEST(Floors, EveryIncludePointsDown) {
  expectNoComplaint(checkFloors);
}
TEST(Floors, EveryHeavyLibraryHasItsOneFile) {
  expectNoComplaint(checkLibraries);
}
TEST(Floors, OnlyTheRoomGlCallsGl) {
  expectNoComplaint(checkGlCalls);
}
TEST(Floors, TheReferenceSharesNothingWithTheGpu) {
  expectNoComplaint(checkReference);
}

TEST(Floors, AComplaintNamesTheLine) {
  EXPECT_EQ(checkFloors({"base/log.cpp", "#pragma once\n#include <string>\n#include \"scene/scene.h\"\n"}),
            Complaints{"base/log.cpp:3: includes scene/scene.h, which stands higher"});
  EXPECT_EQ(checkLibraries({"app/main.cpp", "#include <openvdb/openvdb.h>\n"}).size(), 1u);
  EXPECT_EQ(checkGlCalls({"lists/lists_gpu.cpp", "\n  glDispatchCompute(1, 1, 1);\n"}),
            Complaints{"lists/lists_gpu.cpp:2: calls glDispatchCompute(), which is for gl/"});
  EXPECT_EQ(checkReference({"pipelines/reference_bvh.cpp", "#include \"lists/lists_gpu.h\"\n"}).size(), 1u);
}

TEST(Floors, TellsWhoMayIncludeWhom) {
  const auto allows = [](const char* path, const char* included) {
    return checkFloors({path, std::string("#include \"") + included + "\"\n"}).empty();
  };
  EXPECT_TRUE(allows("app/main.cpp", "pipelines/reference.h"));
  EXPECT_TRUE(allows("pipelines/frame_gpu.cpp", "deepshadow/deepshadow_gpu.h"));
  EXPECT_TRUE(allows("lights/lights_gpu.cpp", "lists/lists_gpu.h"));
  EXPECT_TRUE(allows("lights/lights_gpu.cpp", "lights/geometry.h"));
  EXPECT_TRUE(allows("lists/lists_gpu.cpp", "gl/buffer.h"));
  EXPECT_TRUE(allows("gl/buffer.h", "base/error.h"));
  EXPECT_TRUE(allows("scene/gltf.cpp", "image/image_file.h"));
  EXPECT_TRUE(allows("gl/device.h", "shaders/shared/view.h"));
  EXPECT_TRUE(allows("base/log.cpp", "base/log.h"));

  EXPECT_FALSE(allows("pipelines/reference.cpp", "app/options.h"));
  EXPECT_FALSE(allows("lights/lights_gpu.cpp", "deepshadow/deepshadow_gpu.h"));
  EXPECT_FALSE(allows("deepshadow/deepshadow_gpu.cpp", "lights/lights_gpu.h"));
  EXPECT_FALSE(allows("lists/lists_gpu.cpp", "volumes/volumes_gpu.h"));
  EXPECT_FALSE(allows("lists/lists.cpp", "lists/lists_gpu.h"));
  EXPECT_FALSE(allows("volumes/grid.h", "scene/scene.h"));
  EXPECT_FALSE(allows("volumes/grid.h", "image/image.h"));
  EXPECT_FALSE(allows("scene/gltf.cpp", "gl/texture.h"));
  EXPECT_FALSE(allows("gl/buffer.cpp", "lists/lists_gpu.h"));
  EXPECT_FALSE(allows("image/image.h", "scene/scene.h"));
  EXPECT_FALSE(allows("base/error.h", "image/image.h"));
  EXPECT_FALSE(allows("app/main.cpp", "demos/example.h"));
}

}  // namespace
}  // namespace sfumato
