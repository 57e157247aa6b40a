// OpenVDB files. This room's vdb_file.cpp is the one file that includes OpenVDB; built without it, all
// here throws Input and says so.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "volumes/grid.h"
#include "volumes/vdb_layout.h"

namespace sfumato::volumes {

constexpr size_t usualVdbBytes = size_t{4} << 30;

// A file that is read once, for any of its grids.
class VdbReader {
 public:
  // Throws Input in one line for a missing, truncated or damaged file.
  explicit VdbReader(std::filesystem::path path);

  // Reads one float or half fog volume: active voxels and active tiles, the bounding box of what is not zero
  // plus a margin of one voxel, the linear transform of the file (rotated and sheared ones too). The box is
  // dense in memory up to 64 MiB, and beyond where bricks would not take less than half of that; else it is
  // in bricks. `gridName` empty: "density", else the only float grid. Throws Input in one line: no such grid
  // (the line lists those there are, with their types); a damaged one; a level set, vector, point or integer
  // grid; a transform that is not linear (frustum); a background other than 0; a NaN, infinite or negative
  // density. Throws Memory when that would take more than `maxBytes`, or the map of the bricks more than a
  // quarter of them. `option` is what errors say to choose another grid with.
  DensityGrid read(const std::string& gridName, size_t maxBytes = usualVdbBytes,
                   const std::string& option = "--grid") const;

 private:
  std::filesystem::path path_;
  std::vector<std::byte> file_;
  VdbDirectory directory_;
};

// One of its grids.
DensityGrid readVdb(const std::filesystem::path& path, const std::string& gridName,
                    size_t maxBytes = usualVdbBytes, const std::string& option = "--grid");

// Writes the grid (values other than 0 are active) as a fog volume, beside `path` and then renamed.
// Throws Input when it cannot be written.
void writeVdb(const std::filesystem::path& path, const DensityGrid& grid);
// The same for several, by their names, in one file.
void writeVdb(const std::filesystem::path& path, std::span<const DensityGrid* const> grids);

}  // namespace sfumato::volumes
