// Grids that are mostly empty, for the tests of bricks.
#pragma once

#include <cstdint>

#include "base/random.h"
#include "volumes/grid.h"

namespace sfumato::tests {

// Zeros but for `voxels` random ones at random places inside a margin of one, dense. Values are those of
// halves.
inline volumes::DensityGrid scatteredVoxels(const glm::ivec3& size, int voxels, uint64_t seed) {
  volumes::DensityGrid grid;
  grid.name = "scattered";
  grid.size = size;
  grid.half = true;
  grid.values.assign(grid.valueIndex(0, 0, size.z), 0.f);
  base::Random random(seed);
  for (int i = 0; i < voxels; ++i) {
    glm::ivec3 voxel;
    for (int axis = 0; axis < 3; ++axis)
      voxel[axis] = 1 + static_cast<int>(random.uniform(0, size[axis] - 2));
    grid.values[grid.valueIndex(voxel.x, voxel.y, voxel.z)] =
        static_cast<float>(1 + static_cast<int>(random.uniform(0, 255))) / 256.f;
  }
  return grid;
}

// Sets a voxel of a grid that is in bricks.
inline void setInBricks(volumes::DensityGrid& grid, const glm::ivec3& voxel, float value) {
  constexpr size_t valuesInBrick = volumes::DensityGrid::valuesInBrick;
  uint32_t& brick = grid.bricks.map[grid.brickIndex(voxel)];
  std::vector<float>& values = grid.bricks.values;
  if (brick == 0) {
    values.resize(values.size() + valuesInBrick);
    brick = static_cast<uint32_t>(values.size() / valuesInBrick);
  }
  values[(brick - 1) * valuesInBrick + volumes::DensityGrid::indexInBrick(voxel)] = value;
}

// The map of a grid in bricks, of which none is there yet.
inline void addBrickMap(volumes::DensityGrid& grid) {
  const auto count = glm::dvec3(grid.brickCount());
  grid.bricks.map.assign(static_cast<size_t>(count.x * count.y * count.z), 0);
}

// The same values in bricks.
inline volumes::DensityGrid inBricks(const volumes::DensityGrid& dense) {
  volumes::DensityGrid grid = dense;
  grid.values.clear();
  addBrickMap(grid);
  for (int z = 0; z < dense.size.z; ++z)
    for (int y = 0; y < dense.size.y; ++y)
      for (int x = 0; x < dense.size.x; ++x) {
        const glm::ivec3 voxel(x, y, z);
        if (dense.value(voxel) != 0) setInBricks(grid, voxel, dense.value(voxel));
      }
  return grid;
}

}  // namespace sfumato::tests
