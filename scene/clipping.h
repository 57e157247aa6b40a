// Convex polygons cut by planes.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace sfumato::scene {

using Polygon = std::vector<glm::dvec3>;  // corners in order, of a convex polygon

// The part of a polygon on the sides of the planes where dot(plane, (p, 1)) >= 0 (Sutherland and Hodgman
// 1974). Empty where there is none.
Polygon clipped(Polygon polygon, std::span<const glm::dvec4> planes);

}  // namespace sfumato::scene
