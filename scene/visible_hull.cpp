#include "scene/visible_hull.h"

#include <algorithm>
#include <cmath>

#include "base/box.h"
#include "scene/clipping.h"

namespace sfumato::scene {

using glm::dmat4;
using glm::dvec3;
using glm::dvec4;

namespace {

// Planes of the frustum in world space, their positive sides inside.
std::vector<dvec4> frustumPlanes(const Camera& camera, double aspect) {
  std::vector<dvec4> planes;
  const double y = camera.orthographic ? camera.yMagnitude : std::tan(camera.yfov * 0.5);
  const double x = y * aspect;
  for (const double side : {1.0, -1.0}) {
    if (camera.orthographic) {
      planes.emplace_back(side, 0, 0, x);
      planes.emplace_back(0, side, 0, y);
    } else {
      planes.emplace_back(side, 0, -x, 0);
      planes.emplace_back(0, side, -y, 0);
    }
  }
  planes.emplace_back(0, 0, -1, -camera.nearDistance);
  if (std::isfinite(camera.farDistance)) planes.emplace_back(0, 0, 1, camera.farDistance);
  const dmat4 planeFromView = glm::transpose(glm::inverse(camera.worldFromView));
  for (dvec4& plane : planes) plane = planeFromView * plane;
  return planes;
}

// Of the near plane, and of the far plane where there is one.
std::vector<dvec3> frustumCorners(const Camera& camera, double aspect) {
  std::vector<dvec3> result;
  for (const double depth : {camera.nearDistance, camera.farDistance}) {
    if (!std::isfinite(depth)) continue;
    const double y = camera.orthographic ? camera.yMagnitude : depth * std::tan(camera.yfov * 0.5);
    for (int i = 0; i < 4; ++i) {
      const dvec4 pView((i & 1 ? y : -y) * aspect, i & 2 ? y : -y, -depth, 1);
      result.emplace_back(camera.worldFromView * pView);
    }
  }
  return result;
}

void appendClipped(Polygon polygon, const std::vector<dvec4>& planes, std::vector<dvec3>& points) {
  polygon = clipped(std::move(polygon), planes);
  points.insert(points.end(), polygon.begin(), polygon.end());
}

}  // namespace

std::vector<std::vector<dvec3>> visibleParts(const Scene& scene, const Camera& camera, double aspect) {
  const std::vector<dvec4> planes = frustumPlanes(camera, aspect);
  std::vector<std::vector<dvec3>> parts;
  for (const Instance& instance : scene.instances) {
    std::vector<dvec3>& points = parts.emplace_back();
    const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
    const auto world = [&](size_t index) {
      return dvec3(instance.worldFromObject * dvec4(dvec3(mesh.vertices[mesh.indices[index]].position), 1.0));
    };
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
      appendClipped({world(i), world(i + 1), world(i + 2)}, planes, points);
  }
  return parts;
}

std::vector<std::vector<dvec3>> visibleParts(const std::vector<dmat4>& worldFromUnit, const Camera& camera,
                                             double aspect) {
  const std::vector<dvec4> planes = frustumPlanes(camera, aspect);
  constexpr size_t quads[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                  {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
  std::vector<std::vector<dvec3>> parts;
  for (const dmat4& box : worldFromUnit) {
    std::vector<dvec3>& points = parts.emplace_back();
    const auto corner = base::boxCorners(box);
    for (const auto& quad : quads)
      appendClipped({corner[quad[0]], corner[quad[1]], corner[quad[2]], corner[quad[3]]}, planes, points);
    // Corners of the frustum inside the box bound what is seen of it, too.
    const dmat4 unitFromWorld = glm::inverse(box);
    for (const dvec3& p : frustumCorners(camera, aspect)) {
      const dvec3 unit(unitFromWorld * dvec4(p, 1.0));
      if (glm::all(glm::greaterThanEqual(unit, dvec3(0))) && glm::all(glm::lessThanEqual(unit, dvec3(1))))
        points.push_back(p);
    }
  }
  return parts;
}

std::vector<dvec3> visiblePoints(const Scene& scene, const std::vector<dmat4>& worldFromUnit,
                                 const Camera& camera, double aspect) {
  std::vector<dvec3> points;
  for (const auto& parts : {visibleParts(scene, camera, aspect), visibleParts(worldFromUnit, camera, aspect)})
    for (const std::vector<dvec3>& part : parts) points.insert(points.end(), part.begin(), part.end());
  return points;
}

void Seen::add(const std::vector<std::vector<dvec3>>& visibleParts) {
  for (const std::vector<dvec3>& part : visibleParts) {
    points.insert(points.end(), part.begin(), part.end());
    parts.push_back(boundsOf(part));
  }
}

std::vector<dmat4> boundingBoxes(const Scene& scene) {
  std::vector<Bounds> ofMeshes(scene.meshes.size());
  for (size_t i = 0; i < ofMeshes.size(); ++i) {
    for (const Vertex& vertex : scene.meshes[i].vertices) {
      ofMeshes[i].low = glm::min(ofMeshes[i].low, dvec3(vertex.position));
      ofMeshes[i].high = glm::max(ofMeshes[i].high, dvec3(vertex.position));
    }
  }
  std::vector<dmat4> boxes;
  for (const Instance& instance : scene.instances) {
    const Bounds& box = ofMeshes[static_cast<size_t>(instance.mesh)];
    if (!box.empty()) boxes.push_back(instance.worldFromObject * worldFromUnit(box));
  }
  return boxes;
}

std::vector<dvec3> boundingPoints(const Scene& scene, const std::vector<dmat4>& worldFromUnit) {
  std::vector<dvec3> points;
  const auto append = [&](const dmat4& box) {
    const auto corner = base::boxCorners(box);
    points.insert(points.end(), corner.begin(), corner.end());
  };
  for (const dmat4& box : boundingBoxes(scene)) append(box);
  for (const dmat4& box : worldFromUnit) append(box);
  return points;
}

}  // namespace sfumato::scene
