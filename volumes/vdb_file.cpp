#include "volumes/vdb_file.h"

#include "base/error.h"

#ifdef SFUMATO_OPENVDB

#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>

#include <algorithm>
#include <cmath>
#include <istream>
#include <new>
#include <streambuf>

#include "base/file.h"

namespace sfumato::volumes {
namespace {

using base::ExitCode;
using base::fail;

// For a name from a file in an error line: no control characters, not endless.
std::string shown(const std::string& name) {
  constexpr size_t longest = 64;
  std::string text = name.substr(0, longest);
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ' || c == 0x7f) c = '?';
  return name.size() > longest ? text + "..." : text;
}

std::string listGrids(const VdbDirectory& directory) {
  constexpr size_t most = 16;
  if (directory.entries.empty()) return "no grid at all";
  std::string list;
  for (const VdbEntry& entry : directory.entries) {
    if (&entry == &directory.entries[0] + most) return list + ", ...";
    list += fmt::format("{}{} ({})", list.empty() ? "" : ", ", shown(entry.shownName), shown(entry.type));
  }
  return list;
}

// The float grid of that name; without a name "density", else the only float grid.
const VdbEntry& chooseGrid(const VdbDirectory& directory, const std::string& path,
                           const std::string& gridName, const std::string& option) {
  std::vector<const VdbEntry*> floats, named;
  for (const VdbEntry& entry : directory.entries) {
    if (entry.type != "float") continue;
    floats.push_back(&entry);
    const bool matches =
        gridName.empty() ? entry.name == "density" : entry.name == gridName || entry.shownName == gridName;
    if (matches) named.push_back(&entry);
  }
  if (gridName.empty() && named.empty() && floats.size() == 1) named = floats;
  const std::string wanted = shown(gridName.empty() ? "density" : gridName);
  if (named.empty())
    fail(ExitCode::Input, "{}: no float grid \"{}\" (has: {}): {}", path, wanted, listGrids(directory),
         floats.empty() ? std::string("export one of floats")
                        : fmt::format("choose one with {} NAME", option));
  if (named.size() > 1)
    fail(ExitCode::Input, "{}: {} grids are called \"{}\": choose one with {} \"{}\"", path, named.size(),
         wanted, option, shown(named[0]->shownName));
  return *named[0];
}

// Reads from memory, for OpenVDB's streams.
class MemoryBuffer : public std::streambuf {
 public:
  explicit MemoryBuffer(std::span<const std::byte> bytes) {
    // A streambuf wants char*, but a get area is only read.
    char* begin = const_cast<char*>(reinterpret_cast<const char*>(bytes.data()));
    setg(begin, begin, begin + bytes.size());
  }
};

void readTree(openvdb::FloatTree& tree, std::span<const std::byte> file, const VdbDirectory& directory,
              const VdbGridLayout& layout) {
  MemoryBuffer buffer(file.subspan(layout.treeBegin, layout.treeEnd - layout.treeBegin));
  std::istream stream(&buffer);
  stream.exceptions(std::ios::failbit | std::ios::badbit | std::ios::eofbit);
  openvdb::io::setVersion(stream, {directory.libraryMajor, directory.libraryMinor}, directory.formatVersion);
  openvdb::io::setDataCompression(stream, layout.compression);
  tree.readTopology(stream, layout.half);
  tree.readBuffers(stream, layout.half);
}

// A box is dense up to this, and beyond where bricks would take no less than a part of it.
constexpr size_t alwaysDenseBytes = size_t{64} << 20;
constexpr double mostDenseFactor = 2;

template <typename Vector>
auto product(const Vector& v) {
  return v.x * v.y * v.z;
}

// A box of voxels that grows; 64-bit, as active tiles can make it huge.
struct Box {
  glm::i64vec3 low{std::numeric_limits<int64_t>::max()};
  glm::i64vec3 high{std::numeric_limits<int64_t>::min()};

  void add(const openvdb::CoordBBox& box) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min<int64_t>(low[axis], box.min()[axis]);
      high[axis] = std::max<int64_t>(high[axis], box.max()[axis]);
    }
  }
  bool empty() const { return high.x < low.x; }
};

// The box of all active values other than 0. Throws Input for a value that is no density.
Box checkedBox(const openvdb::FloatTree& tree, const std::string& place) {
  Box box;
  for (auto value = tree.cbeginValueOn(); value; ++value) {
    const float density = *value;
    if (!std::isfinite(density) || density < 0) {
      const openvdb::Coord at = value.getCoord();
      fail(ExitCode::Input, "{} has the density {} at voxel ({}, {}, {}): give finite densities of 0 or more",
           place, density, at.x(), at.y(), at.z());
    }
    if (density != 0) box.add(value.getBoundingBox());
  }
  if (box.empty()) fail(ExitCode::Input, "{} is empty: give one with an active density above 0", place);
  return box;
}

// Calls visit(low, high, density) for the boxes of equal active values other than 0; voxels of `grid`.
template <typename Visit>
void forEachBox(const openvdb::FloatTree& tree, const DensityGrid& grid, const Visit& visit) {
  const auto voxel = [&](const openvdb::Coord& at) {
    return glm::ivec3(at.x(), at.y(), at.z()) - grid.origin;
  };
  for (auto value = tree.cbeginValueOn(); value; ++value) {
    if (*value == 0) continue;
    const openvdb::CoordBBox box = value.getBoundingBox();
    visit(voxel(box.min()), voxel(box.max()), *value);
  }
}

void fillDense(const openvdb::FloatTree& tree, DensityGrid& grid) {
  grid.values.assign(grid.valueIndex(0, 0, grid.size.z), 0.f);
  forEachBox(tree, grid, [&](const glm::ivec3& low, const glm::ivec3& high, float density) {
    const auto count = static_cast<size_t>(high.x - low.x + 1);
    for (int z = low.z; z <= high.z; ++z)
      for (int y = low.y; y <= high.y; ++y)
        std::fill_n(&grid.values[grid.valueIndex(low.x, y, z)], count, density);
  });
}

[[noreturn]] void failTooLarge(const std::string& place, const char* what, const glm::i64vec3& size,
                               double bytes, size_t maxBytes) {
  fail(ExitCode::Memory,
       "{}: {} a box of {} x {} x {} voxels takes {:.1f} MiB, more than the {:.1f} MiB allowed: crop it, or "
       "resample it to larger voxels",
       place, what, size.x, size.y, size.z, bytes / 0x1p20, static_cast<double>(maxBytes) / 0x1p20);
}

// Numbers the bricks that hold anything; returns how many.
size_t numberBricks(const openvdb::FloatTree& tree, DensityGrid& grid) {
  grid.bricks.map.assign(product(glm::i64vec3(grid.brickCount())), 0);
  size_t count = 0;
  forEachBox(tree, grid, [&](const glm::ivec3& low, const glm::ivec3& high, float) {
    const glm::ivec3 first = low / DensityGrid::brickSide, last = high / DensityGrid::brickSide;
    for (int z = first.z; z <= last.z; ++z)
      for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) {
          uint32_t& brick = grid.bricks.map[grid.brickIndex(glm::ivec3(x, y, z) * DensityGrid::brickSide)];
          if (brick == 0) brick = static_cast<uint32_t>(++count);
        }
  });
  return count;
}

void fillBricks(const openvdb::FloatTree& tree, DensityGrid& grid, size_t count) {
  grid.bricks.values.assign(count * DensityGrid::valuesInBrick, 0.f);
  forEachBox(tree, grid, [&](const glm::ivec3& low, const glm::ivec3& high, float density) {
    for (int z = low.z; z <= high.z; ++z)
      for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) {
          const glm::ivec3 voxel(x, y, z);
          const size_t brick = grid.bricks.map[grid.brickIndex(voxel)] - 1;
          grid.bricks.values[brick * DensityGrid::valuesInBrick + DensityGrid::indexInBrick(voxel)] = density;
        }
  });
}

DensityGrid toGrid(const openvdb::FloatTree& tree, const std::string& place, size_t maxBytes) {
  const Box box = checkedBox(tree, place);
  const glm::i64vec3 size = box.high - box.low + int64_t{3};  // with the margin
  const double denseBytes = product(glm::dvec3(size)) * sizeof(float);
  const glm::i64vec3 bricks = (size + int64_t{DensityGrid::brickSide - 1}) / int64_t{DensityGrid::brickSide};
  const double mapBytes = product(glm::dvec3(bricks)) * sizeof(uint32_t);
  constexpr int64_t longest = int64_t{1} << 30;
  if (std::max({size.x, size.y, size.z}) > longest || mapBytes > static_cast<double>(maxBytes) / 4)
    failTooLarge(place, "the map of the bricks in", size, mapBytes, maxBytes / 4);

  DensityGrid grid;
  grid.origin = glm::ivec3(box.low - int64_t{1});
  grid.size = glm::ivec3(size);
  if (denseBytes <= static_cast<double>(std::min(alwaysDenseBytes, maxBytes))) {
    fillDense(tree, grid);
    return grid;
  }
  constexpr size_t brickBytes = DensityGrid::valuesInBrick * sizeof(float);
  const size_t count = numberBricks(tree, grid);
  const double bytes = mapBytes + static_cast<double>(count * brickBytes);
  if (std::min(bytes, denseBytes) > static_cast<double>(maxBytes))
    failTooLarge(place, "what is in", size, std::min(bytes, denseBytes), maxBytes);
  if (denseBytes <= static_cast<double>(maxBytes) && denseBytes <= mostDenseFactor * bytes) {
    grid.bricks = {};
    fillDense(tree, grid);
  } else {
    fillBricks(tree, grid, count);
  }
  return grid;
}

openvdb::Mat4d rowVectorMatrix(const glm::dmat4& matrix) {
  openvdb::Mat4d result;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row) result[column][row] = matrix[column][row];
  return result;
}

void copyDense(const DensityGrid& grid, openvdb::FloatGrid& vdb) {
  const openvdb::Coord origin(grid.origin.x, grid.origin.y, grid.origin.z);
  const openvdb::Coord size(grid.size.x, grid.size.y, grid.size.z);
  // Dense wants to be able to write, but copyFromDense only reads.
  const openvdb::tools::Dense<float, openvdb::tools::LayoutXYZ> dense(
      openvdb::CoordBBox(origin, origin + size.offsetBy(-1)), const_cast<float*>(grid.values.data()));
  openvdb::tools::copyFromDense(dense, vdb, 0.f);
}

void copyBricks(const DensityGrid& grid, openvdb::FloatGrid& vdb) {
  auto accessor = vdb.getAccessor();
  forEachRow(grid, [&](const glm::ivec3& first, std::span<const float> row) {
    openvdb::Coord at(grid.origin.x + first.x, grid.origin.y + first.y, grid.origin.z + first.z);
    for (const float value : row) {
      if (value != 0) accessor.setValue(at, value);
      at.x() += 1;
    }
  });
}

openvdb::FloatGrid::Ptr toVdb(const DensityGrid& grid) {
  const auto vdb = openvdb::FloatGrid::create(0.f);
  vdb->setName(grid.name);
  vdb->setGridClass(openvdb::GRID_FOG_VOLUME);
  vdb->setTransform(openvdb::math::Transform::createLinearTransform(rowVectorMatrix(grid.worldFromIndex)));
  vdb->setSaveFloatAsHalf(grid.half);
  if (grid.dense())
    copyDense(grid, *vdb);
  else
    copyBricks(grid, *vdb);
  return vdb;
}

}  // namespace

VdbReader::VdbReader(std::filesystem::path path)
    : path_(std::move(path)),
      file_(base::readFile(path_)),
      directory_(readVdbDirectory(file_, path_.string())) {}

DensityGrid VdbReader::read(const std::string& gridName, size_t maxBytes, const std::string& option) const {
  const VdbEntry& entry = chooseGrid(directory_, path_.string(), gridName, option);
  const std::string place = fmt::format("{}: grid \"{}\"", path_.string(), shown(entry.shownName));
  const VdbGridLayout layout = layOutVdbGrid(file_, path_.string(), directory_, entry);
  if (layout.gridClass == "level set")
    fail(ExitCode::Input, "{} is a level set, which has distances, not densities: convert it to a fog volume",
         place);
  if (layout.treeBytes > maxBytes)
    fail(ExitCode::Memory,
         "{} takes {:.1f} MiB in memory, more than the {:.1f} MiB allowed: crop it, or "
         "resample it to larger voxels",
         place, static_cast<double>(layout.treeBytes) / 0x1p20, static_cast<double>(maxBytes) / 0x1p20);

  openvdb::initialize();
  openvdb::FloatTree tree(0.f);
  try {
    readTree(tree, file_, directory_, layout);
  } catch (const std::bad_alloc&) {
    fail(ExitCode::Memory, "{} does not fit in memory: crop it, or resample it to larger voxels", place);
  } catch (const std::exception& error) {
    fail(ExitCode::Input, "{} is damaged ({}): copy or export it again", place, shown(error.what()));
  }
  if (tree.background() != 0)
    fail(ExitCode::Input, "{} has the background {}, so it has no end: give a fog volume of background 0",
         place, tree.background());

  DensityGrid grid = toGrid(tree, place, maxBytes);
  grid.name = entry.name;
  grid.worldFromIndex = layout.worldFromIndex;
  grid.half = layout.half;
  return grid;
}

void writeVdb(const std::filesystem::path& path, const DensityGrid& grid) {
  const DensityGrid* one = &grid;
  writeVdb(path, {&one, 1});
}

void writeVdb(const std::filesystem::path& path, std::span<const DensityGrid* const> grids) {
  openvdb::initialize();
  openvdb::GridCPtrVec written;
  for (const DensityGrid* grid : grids) written.push_back(toVdb(*grid));
  base::PendingFile pending(path);
  try {
    openvdb::io::File(pending.temporary().string()).write(written);
    // OpenVDB does not say when the disk is full, so the file is looked through.
    const std::vector<std::byte> file = base::readFile(pending.temporary());
    const VdbDirectory directory = readVdbDirectory(file, path.string());
    for (size_t i = 0; i < written.size(); ++i)
      layOutVdbGrid(file, path.string(), directory, directory.entries.at(i));
  } catch (const std::exception& error) {
    fail(ExitCode::Input, "{}: cannot be written: {}", path.string(), shown(error.what()));
  }
  pending.rename();
}

}  // namespace sfumato::volumes

#else

namespace sfumato::volumes {

VdbReader::VdbReader(std::filesystem::path path) : path_(std::move(path)) {
  base::fail(base::ExitCode::Input, "{}: cannot be read: this build has no OpenVDB", path_.string());
}

DensityGrid VdbReader::read(const std::string&, size_t, const std::string&) const {
  return {};  // there is none
}

void writeVdb(const std::filesystem::path& path, const DensityGrid&) {
  writeVdb(path, std::span<const DensityGrid* const>());
}

void writeVdb(const std::filesystem::path& path, std::span<const DensityGrid* const>) {
  base::fail(base::ExitCode::Input, "{}: cannot be written: this build has no OpenVDB", path.string());
}

}  // namespace sfumato::volumes

#endif

namespace sfumato::volumes {

DensityGrid readVdb(const std::filesystem::path& path, const std::string& gridName, size_t maxBytes,
                    const std::string& option) {
  return VdbReader(path).read(gridName, maxBytes, option);
}

}  // namespace sfumato::volumes
