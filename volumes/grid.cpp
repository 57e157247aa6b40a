#include "volumes/grid.h"

#include <algorithm>

namespace sfumato::volumes {

double voxelSize(const glm::dmat4& worldFromIndex) {
  double shortest = glm::length(glm::dvec3(worldFromIndex[0]));
  for (int axis = 1; axis < 3; ++axis)
    shortest = std::min(shortest, glm::length(glm::dvec3(worldFromIndex[axis])));
  return shortest;
}

}  // namespace sfumato::volumes
