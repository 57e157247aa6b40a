// Grids on the GPU, dense or in bricks, as shaders/volumes/grid.glsl samples them.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <limits>
#include <span>
#include <vector>

#include "gl/buffer.h"
#include "gl/device.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "volumes/grid.h"

namespace sfumato::volumes {

// A grid, and where it stands: metres from its index positions.
struct PlacedGrid {
  const DensityGrid& grid;
  glm::dmat4 worldFromIndex{1.0};
};

struct GridOptions {
  size_t budgetBytes = std::numeric_limits<size_t>::max();  // for all grids together, on the device
  int textureSide = std::numeric_limits<int>::max();  // most texels of a texture; only tests ask for less
                                                      // than the device has
};

class GridsGpu {
 public:
  // Uploads the grids in their order, at 2 or 4 bytes a value. A grid that is dense on the CPU is a dense
  // texture where the device and the budget allow it; others are bricks of 8 cells a side, and more where
  // their map would be too large. Throws Memory where that does not fit either.
  GridsGpu(gl::Device& device, std::span<const PlacedGrid> grids, const GridOptions& options = {});

  size_t count() const { return textures_.size(); }
  // GRID_COUNT, GRID_BRICKS and GRID_BRICK_SIDE, for programs that include shaders/volumes/grid.glsl.
  gl::ShaderDefines defines() const;
  void bind() const;

 private:
  int brickSide_ = 0;
  unsigned inBricks_ = 0;  // a bit a grid
  std::vector<gl::Texture> textures_;
  gl::Texture map_;
  gl::Buffer data_;
};

}  // namespace sfumato::volumes
