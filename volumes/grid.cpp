#include "volumes/grid.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

namespace sfumato::volumes {

glm::dmat4 worldFromUnit(const Medium& medium) {
  const glm::dmat4 indexFromUnit = glm::translate(glm::dmat4(1.0), glm::dvec3(medium.grid.origin)) *
                                   glm::scale(glm::dmat4(1.0), glm::dvec3(medium.grid.size - 1));
  return medium.worldFromIndex * indexFromUnit;
}

double voxelSize(const glm::dmat4& worldFromIndex) {
  double shortest = glm::length(glm::dvec3(worldFromIndex[0]));
  for (int axis = 1; axis < 3; ++axis)
    shortest = std::min(shortest, glm::length(glm::dvec3(worldFromIndex[axis])));
  return shortest;
}

}  // namespace sfumato::volumes
