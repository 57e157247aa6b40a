// Which parts of a grid hold anything, and how far it is to the next that does: what a march may jump over.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "volumes/grid.h"

namespace sfumato::volumes {

// Bricks of side^3 cells. A cell lies between eight voxels, so a brick has (side + 1)^3 of them, the outer
// ones in common with its neighbours. It is filled where one of them is not 0.
struct BrickMap {
  int side = 0;
  glm::ivec3 count{0};             // bricks along x, y, z
  std::vector<uint32_t> distance;  // of each, at place(): bricks to the next filled one, along the farthest
                                   // axis; 0 where it is filled itself
  size_t filled = 0;

  // There is a margin of one brick around: coordinates from -1 to count.
  size_t place(const glm::ivec3& brick) const { return placeIn(count + 2, brick + 1); }
};

// Bricks along each axis that hold every voxel.
glm::ivec3 brickCount(const DensityGrid& grid, int side);

// Costs a pass over the voxels that are stored, and 4 bytes a brick.
BrickMap mapBricks(const DensityGrid& grid, int side);

}  // namespace sfumato::volumes
