// Where things stand in a .vdb file, found without trusting it. OpenVDB's own reader believes every size that
// a file states, and a damaged one makes it write out of bounds; so a file is walked here first, and OpenVDB
// sees only trees whose every block fits. Layout: OpenVDB's io/Archive, io/Compression, tree/*Node of format
// versions 222 to 224 (OpenVDB 1 to 12). Nothing of OpenVDB is included.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

namespace sfumato::volumes {

// One grid of a file.
struct VdbEntry {
  std::string name;       // may be that of other grids too
  std::string shownName;  // "density", or "density[1]" where the file numbers several of one name
  std::string type;       // of a voxel: "float", "vec3s", …; as in the file where it is not a usual tree
  bool half = false;      // 32-bit floats, stored as 16-bit ones
  std::string treeOf;     // name in the file of the grid whose tree this one shares, or empty
  size_t position = 0;    // of its metadata, in bytes
  std::string key;        // the name as stored, unique in the file
};

struct VdbDirectory {
  uint32_t formatVersion = 0;
  uint32_t libraryMajor = 0;
  uint32_t libraryMinor = 0;
  std::vector<VdbEntry> entries;
};

// A float grid: all that stands before its tree, and how far the tree reaches.
struct VdbGridLayout {
  std::string gridClass;           // "fog volume", "level set", …, empty when not said
  glm::dmat4 worldFromIndex{1.0};  // for column vectors; finite and invertible
  uint32_t compression = 0;        // OpenVDB's flags: 1 zip, 2 active values only, 4 blosc
  bool half = false;               // the tree's floats are stored as 16-bit ones
  size_t treeBegin = 0;            // bytes
  size_t treeEnd = 0;
  size_t treeBytes = 0;  // what the tree's nodes take in memory
};

// The grids of a file. Throws Input, in a line that starts with `path`: not a .vdb file, a version that is
// not known, truncated or damaged.
VdbDirectory readVdbDirectory(std::span<const std::byte> file, const std::string& path);

// Walks the grid `entry` of type float. Throws Input likewise, and for a transform that is not linear.
VdbGridLayout layOutVdbGrid(std::span<const std::byte> file, const std::string& path,
                            const VdbDirectory& directory, const VdbEntry& entry);

}  // namespace sfumato::volumes
