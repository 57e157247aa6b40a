// Density on a regular lattice, dense in memory or in bricks, and the medium that it makes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace sfumato::volumes {

// The number of place p in a box, in order of x first, then y, then z.
inline size_t placeIn(const glm::ivec3& size, const glm::ivec3& p) {
  return (static_cast<size_t>(p.z) * static_cast<size_t>(size.y) + static_cast<size_t>(p.y)) *
             static_cast<size_t>(size.x) +
         static_cast<size_t>(p.x);
}

// The value of voxel (i,j,k) stands at index position (i,j,k), trilinear between; outside the box it is 0.
// A margin of one zero voxel on every side keeps that true up to the box. Values are finite and >= 0; in
// order of x first, then y, then z.
struct DensityGrid {
  // What is mostly empty: cubes of brickSide^3 voxels, of which those that hold only zeros are left out.
  static constexpr int brickSide = 8;
  struct Bricks {
    std::vector<uint32_t> map;  // for each brick, also in order of x, y, z: 0, or its number plus 1
    std::vector<float> values;  // brick by brick
  };

  std::string name;
  glm::ivec3 origin{0};       // index position of the first voxel
  glm::ivec3 size{0};         // voxels along x, y, z, margin included
  std::vector<float> values;  // of all voxels, or none where they are in bricks
  Bricks bricks;
  bool half = false;               // every value is one of a 16-bit float
  glm::dmat4 worldFromIndex{1.0};  // the grid's own affine transform: metres from index positions

  bool dense() const { return bricks.map.empty(); }
  size_t bytes() const {
    return (values.size() + bricks.values.size()) * sizeof(float) + bricks.map.size() * sizeof(uint32_t);
  }

  // Places of a voxel, counted from the first one: in `values`, of its brick in the map, and in that brick.
  size_t valueIndex(int x, int y, int z) const { return placeIn(size, {x, y, z}); }
  size_t brickIndex(const glm::ivec3& voxel) const { return placeIn(brickCount(), voxel / brickSide); }
  static size_t indexInBrick(const glm::ivec3& voxel) {
    return placeIn(glm::ivec3(brickSide), voxel % brickSide);
  }
  glm::ivec3 brickCount() const { return (size + brickSide - 1) / brickSide; }
  static constexpr size_t valuesInBrick = size_t{brickSide} * brickSide * brickSide;

  float value(const glm::ivec3& voxel) const {
    if (dense()) return values[valueIndex(voxel.x, voxel.y, voxel.z)];
    const uint32_t brick = bricks.map[brickIndex(voxel)];
    return brick == 0 ? 0.f : bricks.values[(brick - 1) * valuesInBrick + indexInBrick(voxel)];
  }
};

// Calls visit(voxel, values) for the rows along x of which the grid consists; voxels are counted from the
// first one. Only zeros are left out.
template <typename Visit>
void forEachRow(const DensityGrid& grid, const Visit& visit) {
  const auto forBox = [&](const glm::ivec3& low, const glm::ivec3& size, const float* values) {
    const auto count = static_cast<size_t>(size.x);
    for (int z = 0; z < size.z; ++z)
      for (int y = 0; y < size.y; ++y, values += count)
        visit(low + glm::ivec3(0, y, z), std::span(values, count));
  };
  if (grid.dense()) return forBox(glm::ivec3(0), grid.size, grid.values.data());
  const glm::ivec3 count = grid.brickCount();
  const uint32_t* brick = grid.bricks.map.data();
  for (int z = 0; z < count.z; ++z)
    for (int y = 0; y < count.y; ++y)
      for (int x = 0; x < count.x; ++x, ++brick)
        if (*brick != 0)
          forBox(glm::ivec3(x, y, z) * DensityGrid::brickSide, glm::ivec3(DensityGrid::brickSide),
                 grid.bricks.values.data() + (*brick - 1) * DensityGrid::valuesInBrick);
}

// What glows by itself, whether or not it takes light: each value of the grid emits a radiance per metre.
struct Fire {
  DensityGrid grid;                // of temperatures or flames
  glm::dmat4 worldFromIndex{1.0};  // placement times the grid's own transform
  double top = 1;                  // value at the ramp's end, and where that holds from
  std::vector<glm::vec3> ramp;  // two entries or more at equal steps of the value from 0 on, linear between
};

// sigma_t = density * scale * extinctionColour [1/m] per channel, scattering albedo per channel,
// Henyey-Greenstein g.
struct Medium {
  DensityGrid grid;
  glm::dmat4 worldFromIndex{1.0};  // placement times the grid's own transform
  double scale = 1;                // 1/m per unit of density
  glm::dvec3 extinctionColour{1};  // each >= 0
  glm::dvec3 albedo{0.9};
  double g = 0;
  std::optional<Fire> fire;
};

// The medium's box, from its first voxel to its last, as the image of the unit cube.
glm::dmat4 worldFromUnit(const Medium& medium);

// Length in metres of the shortest step between neighbouring voxels.
double voxelSize(const glm::dmat4& worldFromIndex);

}  // namespace sfumato::volumes
