#include "volumes/vdb_layout.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <set>

#include "base/error.h"

namespace sfumato::volumes {
namespace {

using base::ExitCode;
using base::fail;
using Bytes = std::span<const std::byte>;

constexpr uint32_t zipFlag = 1, activeMaskFlag = 2, bloscFlag = 4;
constexpr uint32_t oldestVersion = 222, newestVersion = 224;

// Reads forward through the file; every read is checked against what is left.
class Cursor {
 public:
  Cursor(Bytes file, const std::string& path) : file_(file), path_(path) {}

  size_t position() const { return position_; }
  size_t left() const { return file_.size() - position_; }

  void seek(int64_t position) {
    if (position < 0 || static_cast<uint64_t>(position) > file_.size()) damaged("an offset outside the file");
    position_ = static_cast<size_t>(position);
  }

  Bytes take(size_t count) {
    if (count > left()) damaged("it ends too early");
    const Bytes taken = file_.subspan(position_, count);
    position_ += count;
    return taken;
  }

  template <typename T>
  T read() {
    T value;
    std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
    return value;
  }

  std::string readString() {
    const Bytes text = take(read<uint32_t>());
    return {reinterpret_cast<const char*>(text.data()), text.size()};
  }

  [[noreturn]] void damaged(const char* why) const {
    fail(ExitCode::Input, "{}: truncated or damaged at byte {} ({}): copy or export it again", path_,
         position_, why);
  }

 private:
  Bytes file_;
  const std::string& path_;
  size_t position_ = 0;
};

bool endsWith(const std::string& text, const std::string& ending, std::string& head) {
  if (!text.ends_with(ending)) return false;
  head = text.substr(0, text.size() - ending.size());
  return true;
}

// "Tree_float_5_4_3" is "float".
std::string voxelType(const std::string& treeType) {
  std::string type;
  if (!treeType.starts_with("Tree_") || !endsWith(treeType.substr(5), "_5_4_3", type)) return treeType;
  return type;
}

VdbEntry readEntry(Cursor& in) {
  VdbEntry entry;
  entry.key = in.readString();
  // Several grids of one name are told apart by a record separator and a number.
  const size_t separator = entry.key.find('\x1e');
  entry.name = entry.key.substr(0, separator);
  entry.shownName = separator == std::string::npos
                        ? entry.name
                        : fmt::format("{}[{}]", entry.name, entry.key.substr(separator + 1));
  std::string type = in.readString();
  entry.half = endsWith(type, "_HalfFloat", type);
  entry.type = voxelType(type);
  entry.treeOf = in.readString();
  const auto position = in.read<int64_t>();
  in.read<int64_t>();  // where the voxels begin, which is found by walking
  const auto end = in.read<int64_t>();
  if (position < 0 || end <= position || static_cast<uint64_t>(position) < in.position())
    in.damaged("grid offsets that do not follow each other");
  entry.position = static_cast<size_t>(position);
  in.seek(end);
  return entry;
}

void skipMetadata(Cursor& in, std::string* gridClass) {
  for (auto count = in.read<uint32_t>(); count > 0; --count) {
    const std::string name = in.readString();
    const std::string type = in.readString();
    const std::string value = in.readString();
    if (gridClass && name == "class" && type == "string") *gridClass = value;
  }
}

glm::dvec3 readVec3(Cursor& in) {
  const auto v = in.read<std::array<double, 3>>();
  return {v[0], v[1], v[2]};
}

// OpenVDB multiplies row vectors, so its rows are the columns here.
glm::dmat4 readMatrix(Cursor& in) {
  glm::dmat4 matrix;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row) matrix[column][row] = in.read<double>();
  return matrix;
}

glm::dmat4 scaleAndTranslation(const glm::dvec3& scale, const glm::dvec3& translation) {
  glm::dmat4 matrix(1.0);
  for (int axis = 0; axis < 3; ++axis) {
    matrix[axis][axis] = scale[axis];
    matrix[3][axis] = translation[axis];
  }
  return matrix;
}

glm::dmat4 readTransform(Cursor& in, const std::string& path, const std::string& grid) {
  constexpr size_t derivedBytes = 4 * sizeof(std::array<double, 3>);  // inverses that follow a scale
  const std::string type = in.readString();
  glm::dmat4 matrix(1.0);
  if (type == "AffineMap" || type == "UnitaryMap") {
    matrix = readMatrix(in);
  } else if (type == "TranslationMap") {
    matrix = scaleAndTranslation(glm::dvec3(1.0), readVec3(in));
  } else if (type == "ScaleMap" || type == "UniformScaleMap") {
    matrix = scaleAndTranslation(readVec3(in), glm::dvec3(0.0));
    in.take(derivedBytes);
  } else if (type == "ScaleTranslateMap" || type == "UniformScaleTranslateMap") {
    const glm::dvec3 translation = readVec3(in);
    matrix = scaleAndTranslation(readVec3(in), translation);
    in.take(derivedBytes);
  } else if (type == "NonlinearFrustumMap") {
    fail(ExitCode::Input,
         "{}: grid \"{}\" has a frustum transform, which is not linear: resample it to a box of equal voxels",
         path, grid);
  } else {
    in.damaged("a transform of an unknown kind");
  }
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      if (!std::isfinite(matrix[column][row]) || matrix[column][3] != (column == 3 ? 1.0 : 0.0))
        in.damaged("a transform that is not affine");
  const double determinant = glm::determinant(matrix);
  if (determinant == 0 || !std::isfinite(determinant)) in.damaged("a transform that cannot be inverted");
  return matrix;
}

// Goes over the tree of a float grid in the order in which OpenVDB reads it.
class TreeWalk {
 public:
  TreeWalk(Cursor& in, uint32_t compression, bool half) : in_(in), compression_(compression), half_(half) {}

  // Returns the bytes that the nodes take in memory.
  size_t walk() {
    if (in_.read<int32_t>() != 1) in_.damaged("a tree with several buffers");
    in_.read<float>();  // background
    const auto tiles = in_.read<uint32_t>();
    const auto children = in_.read<uint32_t>();
    std::set<std::array<int32_t, 3>> origins;
    for (uint32_t i = 0; i < tiles; ++i) {
      readOrigin(origins);
      in_.read<float>();
      if (in_.read<uint8_t>() > 1) in_.damaged("a tile that is neither on nor off");
    }
    for (uint32_t i = 0; i < children; ++i) {
      readOrigin(origins);
      walkInternal(5);
    }
    for (size_t i = 0; i < leaves_; ++i) walkValues(leafValues, in_.take(leafValues / 8));
    return memory_;
  }

 private:
  static constexpr size_t leafValues = 8 * 8 * 8;

  void readOrigin(std::set<std::array<int32_t, 3>>& origins) {
    constexpr int32_t span = 4096, farthest = 1 << 30;
    const auto origin = in_.read<std::array<int32_t, 3>>();
    for (const int32_t c : origin)
      if (c % span != 0 || c < -farthest || c > farthest) in_.damaged("a tree node where none can stand");
    if (!origins.insert(origin).second) in_.damaged("two tree nodes in one place");
  }

  // A node of (2^log2Side)^3 places; those of 2^5 hold ones of 2^4, which hold leaves.
  void walkInternal(int log2Side) {
    const size_t places = size_t{1} << (3 * log2Side);
    const Bytes childMask = in_.take(places / 8);
    walkValues(places, in_.take(places / 8));
    memory_ += places * sizeof(void*);
    for (size_t child = countOn(childMask); child > 0; --child) {
      if (log2Side == 5) {
        walkInternal(4);
      } else {
        in_.take(leafValues / 8);  // the leaf's mask; its values come after all nodes
        memory_ += leafValues * sizeof(float);
        ++leaves_;
      }
    }
  }

  // The values of a node: flags, up to two values and a mask for what is inactive, and a block of the rest.
  void walkValues(size_t places, Bytes valueMask) {
    const auto flags = in_.read<int8_t>();
    if (flags < 0 || flags > 6) in_.damaged("an unknown kind of node");
    constexpr int allValues = 6;
    constexpr std::array inactiveValues = {0, 0, 1, 0, 1, 2, 0};
    in_.take(static_cast<size_t>(inactiveValues[static_cast<size_t>(flags)]) * sizeof(float));
    if (flags >= 3 && flags < allValues) in_.take(places / 8);
    const bool activeOnly = (compression_ & activeMaskFlag) != 0 && flags != allValues;
    const size_t count = activeOnly ? countOn(valueMask) : places;
    if (half_ && count == 0) return;
    walkBlock(count * (half_ ? sizeof(uint16_t) : sizeof(float)));
  }

  void walkBlock(size_t bytes) {
    if ((compression_ & (zipFlag | bloscFlag)) == 0) {
      in_.take(bytes);
      return;
    }
    const auto stored = in_.read<int64_t>();
    if (stored <= 0) {  // kept as it is
      if (static_cast<uint64_t>(0) - static_cast<uint64_t>(stored) != bytes)
        in_.damaged("a block of the wrong size");
      in_.take(bytes);
      return;
    }
    const Bytes block = in_.take(static_cast<size_t>(stored));
    if ((compression_ & bloscFlag) != 0) checkBlosc(block, bytes);
  }

  // The blosc header states both sizes; its decoder reads as far as they say.
  void checkBlosc(Bytes block, size_t bytes) {
    constexpr size_t headerBytes = 16;
    std::array<uint32_t, 4> header{};
    if (block.size() < headerBytes) in_.damaged("a block of the wrong size");
    std::memcpy(header.data(), block.data(), headerBytes);
    if (header[1] != bytes || header[3] != block.size()) in_.damaged("a block of the wrong size");
  }

  static size_t countOn(Bytes mask) {
    size_t count = 0;
    for (const std::byte byte : mask) count += static_cast<size_t>(std::popcount(static_cast<uint8_t>(byte)));
    return count;
  }

  Cursor& in_;
  const uint32_t compression_;
  const bool half_;
  size_t leaves_ = 0;
  size_t memory_ = 0;
};

// The entry whose tree `entry` shows: itself, or the one it shares with.
const VdbEntry& treeOwner(const VdbDirectory& directory, const VdbEntry& entry, const Cursor& in) {
  if (entry.treeOf.empty()) return entry;
  const auto owner = std::find_if(directory.entries.begin(), directory.entries.end(),
                                  [&](const VdbEntry& other) { return other.key == entry.treeOf; });
  if (owner == directory.entries.end() || !owner->treeOf.empty() || owner->type != entry.type)
    in.damaged("a grid that shares a tree which is not there");
  return *owner;
}

}  // namespace

VdbDirectory readVdbDirectory(Bytes file, const std::string& path) {
  constexpr int64_t magic = 0x56444220;
  constexpr size_t magicBytes = 8, uuidBytes = 36;
  Cursor in(file, path);
  if (file.empty()) fail(ExitCode::Input, "{}: is empty: copy or export it again", path);
  if (file.size() < magicBytes || in.read<int64_t>() != magic)
    fail(ExitCode::Input, "{}: is not an OpenVDB file: give a .vdb file", path);

  VdbDirectory directory;
  directory.formatVersion = in.read<uint32_t>();
  if (directory.formatVersion < oldestVersion || directory.formatVersion > newestVersion)
    fail(ExitCode::Input, "{}: is of .vdb format {}, and {} to {} are known: save it with another OpenVDB",
         path, directory.formatVersion, oldestVersion, newestVersion);
  directory.libraryMajor = in.read<uint32_t>();
  directory.libraryMinor = in.read<uint32_t>();
  if (in.read<uint8_t>() == 0)
    fail(ExitCode::Input, "{}: was written as a stream, without grid offsets: save it as a file", path);
  in.take(uuidBytes);
  skipMetadata(in, nullptr);
  for (auto count = in.read<int32_t>(); count > 0; --count) directory.entries.push_back(readEntry(in));
  return directory;
}

VdbGridLayout layOutVdbGrid(Bytes file, const std::string& path, const VdbDirectory& directory,
                            const VdbEntry& entry) {
  Cursor in(file, path);
  in.seek(static_cast<int64_t>(entry.position));
  VdbGridLayout layout;
  layout.compression = in.read<uint32_t>();
  skipMetadata(in, &layout.gridClass);
  layout.worldFromIndex = readTransform(in, path, entry.shownName);

  const VdbEntry& owner = treeOwner(directory, entry, in);
  if (&owner != &entry) {
    in.seek(static_cast<int64_t>(owner.position));
    layout.compression = in.read<uint32_t>();
    skipMetadata(in, nullptr);
    readTransform(in, path, owner.shownName);
  }
  if (layout.compression > (zipFlag | activeMaskFlag | bloscFlag)) in.damaged("an unknown compression");
  layout.treeBegin = in.position();
  layout.half = owner.half;
  layout.treeBytes = TreeWalk(in, layout.compression, layout.half).walk();
  layout.treeEnd = in.position();
  return layout;
}

}  // namespace sfumato::volumes
