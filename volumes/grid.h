// Density on a regular lattice, dense in memory, and the medium that it makes.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace sfumato::volumes {

// The value of voxel (i,j,k) stands at index position (i,j,k), trilinear between; outside the box it is 0.
// A margin of one zero voxel on every side keeps that true up to the box.
struct DensityGrid {
  std::string name;
  glm::ivec3 origin{0};            // index position of values[0]
  glm::ivec3 size{0};              // voxels along x, y, z, margin included
  std::vector<float> values;       // x fastest, then y, then z; finite and >= 0
  glm::dmat4 worldFromIndex{1.0};  // the grid's own affine transform: metres from index positions

  size_t valueIndex(int x, int y, int z) const {
    return (static_cast<size_t>(z) * static_cast<size_t>(size.y) + static_cast<size_t>(y)) *
               static_cast<size_t>(size.x) +
           static_cast<size_t>(x);
  }
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
};

// The medium's box, from its first voxel to its last, as the image of the unit cube.
glm::dmat4 worldFromUnit(const Medium& medium);

// Length in metres of the shortest step between neighbouring voxels.
double voxelSize(const glm::dmat4& worldFromIndex);

}  // namespace sfumato::volumes
