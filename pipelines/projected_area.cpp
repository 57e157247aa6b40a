#include "pipelines/projected_area.h"

#include <algorithm>
#include <cmath>

#include "scene/clipping.h"

namespace sfumato::pipelines {

using glm::dvec2;
using glm::dvec3;
using glm::dvec4;

namespace {

// Where the four samples of a pixel stand about its centre, as all devices have them.
constexpr double samplePlaces[4][2] = {{-0.125, -0.375}, {0.375, -0.125}, {-0.375, 0.125}, {0.125, 0.375}};
constexpr double sampleHullArea = 0.3125;

double cross(const dvec2& a, const dvec2& b) {
  return a.x * b.y - a.y * b.x;
}

// How far the samples stand out along a vector, times its length.
double sampleReach(const dvec2& direction) {
  double reach = 0;
  for (const auto& place : samplePlaces)
    reach = std::max(reach, glm::dot(direction, dvec2(place[0], place[1])));
  return reach;
}

// Whether an edge is one that the image's border cut.
bool alongBorder(const dvec2& a, const dvec2& b, const dvec2& size) {
  for (int axis = 0; axis < 2; ++axis)
    for (const double border : {0.0, size[axis]})
      if (std::max(std::abs(a[axis] - border), std::abs(b[axis] - border)) < 1e-6) return true;
  return false;
}

}  // namespace

FragmentCount::FragmentCount(const ProjectionArea& area) : area_(area) {
  for (const double side : {1.0, -1.0}) {
    for (int axis = 0; axis < 2; ++axis) {
      dvec4 plane(0);
      plane[axis] = side;
      plane[area.orthographic ? 3 : 2] = area.orthographic ? area.halfExtent[axis] : -area.halfExtent[axis];
      planes_.push_back(plane);
    }
  }
  // A perspective image has no place for what is at the eye.
  const double nearest = area.orthographic ? area.nearDistance : std::max(area.nearDistance, 1e-9);
  if (std::isfinite(nearest)) planes_.emplace_back(0, 0, -1, -nearest);
  if (std::isfinite(area.farDistance)) planes_.emplace_back(0, 0, 1, area.farDistance);
}

double FragmentCount::of(const std::array<dvec3, 3>& corners, bool cull) const {
  scene::Polygon polygon;
  for (const dvec3& corner : corners) polygon.emplace_back(area_.viewFromWorld * dvec4(corner, 1.0));
  polygon = scene::clipped(std::move(polygon), planes_);
  std::vector<dvec2> image;  // in pixels
  for (const dvec3& p : polygon)
    image.push_back((dvec2(p) / (area_.halfExtent * (area_.orthographic ? 1.0 : -p.z)) + 1.0) * 0.5 *
                    area_.size);
  double area = 0;
  double outline = 0;  // what the samples' spread adds along the edges
  for (size_t i = 0; i < image.size(); ++i) {
    const dvec2& a = image[i];
    const dvec2& b = image[(i + 1) % image.size()];
    area += 0.5 * cross(a - image[0], b - image[0]);
    if (!alongBorder(a, b, area_.size)) outline += sampleReach({b.y - a.y, a.x - b.x});
  }
  if (!std::isfinite(area) || (cull && area < 0)) return 0;
  area = std::abs(area);
  if (area_.samples == 1) return area;
  // The area of all places of a pixel that has a sample in the triangle; of small ones each sample is by
  // itself.
  return std::min(area + (outline > 0 ? outline + sampleHullArea : 0), 4 * area);
}

}  // namespace sfumato::pipelines
