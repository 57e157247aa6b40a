// Boxes that stand anywhere: images of the unit cube.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <glm/glm.hpp>

namespace sfumato::base {

inline std::array<glm::dvec3, 8> boxCorners(const glm::dmat4& worldFromUnit) {
  std::array<glm::dvec3, 8> result;
  for (int i = 0; i < 8; ++i)
    result[static_cast<size_t>(i)] = glm::dvec3(worldFromUnit * glm::dvec4(i & 1, i >> 1 & 1, i >> 2, 1));
  return result;
}

// Depth (along -Z of a view) of the farthest corner; 0 where all are behind it.
inline double farthestDepth(const glm::dmat4& worldFromView, const glm::dmat4& worldFromUnit) {
  double farthest = 0;
  for (const glm::dvec3& p : boxCorners(glm::inverse(worldFromView) * worldFromUnit))
    farthest = std::max(farthest, -p.z);
  return farthest;
}

}  // namespace sfumato::base
