#include "scene/bounds.h"

#include <vector>

#include "base/box.h"

namespace sfumato::scene {

using glm::dvec3;

dvec3 corner(const Bounds& bounds, int which) {
  return {which & 1 ? bounds.high.x : bounds.low.x, which & 2 ? bounds.high.y : bounds.low.y,
          which & 4 ? bounds.high.z : bounds.low.z};
}

Bounds boundsOf(std::span<const dvec3> points) {
  Bounds bounds;
  for (const dvec3& p : points) {
    bounds.low = glm::min(bounds.low, p);
    bounds.high = glm::max(bounds.high, p);
  }
  return bounds;
}

Bounds boundsOf(std::span<const volumes::Medium> media) {
  std::vector<dvec3> corners;
  for (const volumes::Medium& medium : media)
    for (const dvec3& p : base::boxCorners(volumes::worldFromUnit(medium))) corners.push_back(p);
  return boundsOf(corners);
}

glm::dmat4 worldFromUnit(const Bounds& bounds) {
  glm::dmat4 result(1.0);
  for (int axis = 0; axis < 3; ++axis) result[axis][axis] = bounds.high[axis] - bounds.low[axis];
  result[3] = glm::dvec4(bounds.low, 1.0);
  return result;
}

}  // namespace sfumato::scene
