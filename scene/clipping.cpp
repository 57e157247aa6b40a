#include "scene/clipping.h"

#include <algorithm>

namespace sfumato::scene {

using glm::dvec3;
using glm::dvec4;

namespace {

Polygon clip(const Polygon& polygon, const dvec4& plane) {
  const auto height = [&](const dvec3& p) { return glm::dot(plane, dvec4(p, 1.0)); };
  if (std::all_of(polygon.begin(), polygon.end(), [&](const dvec3& p) { return height(p) >= 0; }))
    return polygon;
  Polygon kept;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const dvec3& a = polygon[i];
    const dvec3& b = polygon[(i + 1) % polygon.size()];
    const double ha = height(a);
    const double hb = height(b);
    if (ha >= 0) kept.push_back(a);
    if ((ha >= 0) != (hb >= 0)) kept.push_back(a + (b - a) * (ha / (ha - hb)));
  }
  return kept;
}

}  // namespace

Polygon clipped(Polygon polygon, std::span<const dvec4> planes) {
  for (const dvec4& plane : planes) {
    if (polygon.empty()) break;
    polygon = clip(polygon, plane);
  }
  return polygon;
}

}  // namespace sfumato::scene
