#include "pipelines/shadow_resolution.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "lights/light_reach.h"
#include "pipelines/image_bounds.h"
#include "scene/light_faces.h"
#include "scene/visible_hull.h"

namespace sfumato::pipelines {

using glm::dvec2;
using glm::dvec3;
using scene::Bounds;

namespace {

constexpr double slack = 1e-6;  // of everything's size: rounding loses no light

// The box around what a light reaches: a sphere, or the part of one in a cone.
Bounds boxOf(const lights::Light& light) {
  const double reach = lights::reach(light) * (1 + slack);
  Bounds box{light.position, light.position};
  for (int axis = 0; axis < 3; ++axis) {
    double up = 1;
    double down = 1;
    if (light.type == lights::LightType::Spot) {
      const double angle = std::acos(std::clamp(light.direction[axis], -1.0, 1.0));
      up = std::cos(std::clamp(angle - light.outerCone, 0.0, M_PI_2));
      down = std::cos(std::clamp(M_PI - angle - light.outerCone, 0.0, M_PI_2));
    }
    box.high[axis] += up * reach;
    box.low[axis] -= down * reach;
  }
  return box;
}

bool reachesSome(const lights::Light& light, const Bounds& box) {
  const dvec3 nearest = glm::clamp(light.position, box.low, box.high);
  if (glm::distance(light.position, nearest) > lights::reach(light) * (1 + slack)) return false;
  if (light.type == lights::LightType::Point) return true;
  const dvec3 away = box.centre() - light.position;
  const double distance = glm::length(away);
  if (distance <= box.radius()) return true;
  const double angle = std::acos(std::clamp(glm::dot(away / distance, light.direction), -1.0, 1.0));
  return angle <= light.outerCone + std::asin(box.radius() / distance) + slack;
}

// Of `box`, what the light may reach; empty where it does not.
Bounds litPart(const lights::Light& light, const Bounds& box) {
  if (light.type == lights::LightType::Directional) return box;
  const Bounds reached = boxOf(light);
  const Bounds lit{glm::max(box.low, reached.low), glm::min(box.high, reached.high)};
  if (glm::any(glm::greaterThan(lit.low, lit.high)) || !reachesSome(light, lit)) return {};
  return lit;
}

// Corners of what the light may reach of the parts, cut to the camera's view; nothing where it reaches none
// of them.
std::optional<std::vector<dvec3>> seenAndLit(const lights::Light& light, std::span<const Bounds> parts,
                                             const scene::Camera& camera, double aspect) {
  std::optional<std::vector<dvec3>> points;
  for (const Bounds& part : parts) {
    if (part.empty()) continue;
    const Bounds lit = litPart(light, part);
    if (lit.empty()) continue;
    if (!points) points.emplace();
    const Bounds solid{lit.low, glm::max(lit.high, lit.low + 1e-9)};
    const auto seen = scene::visiblePoints({}, {scene::worldFromUnit(solid)}, camera, aspect);
    points->insert(points->end(), seen.begin(), seen.end());
  }
  return points;
}

double pixelsAround(const std::vector<dvec3>& points, const scene::Camera& camera, int width, int height) {
  const ImageBounds bounds = boundsOnImage(points, camera);
  const dvec2 size = glm::max(bounds.high - bounds.low, dvec2(0));
  return std::min(std::max(size.x, size.y) * height, double(std::max(width, height)));
}

// Of the width of a face of the light's map, what the points take up. Faces of directional lights are fitted
// to them.
double shareOfFace(const lights::Light& light, const std::vector<dvec3>& points) {
  if (light.type == lights::LightType::Directional) return 1;
  dvec3 middle(0);
  for (const dvec3& p : points) middle += glm::normalize(p - light.position);
  middle = glm::normalize(middle);
  double farthest = 1;  // cosine
  for (const dvec3& p : points)
    farthest = std::min(farthest, glm::dot(glm::normalize(p - light.position), middle));
  const double halfFace = scene::isNarrowSpot(light) ? light.outerCone : M_PI_4;
  const double share = std::acos(std::max(farthest, -1.0)) / halfFace;
  return share < 1 ? share : 1;  // also where it is no number: a point at the light
}

}  // namespace

double pixelsLit(const lights::Light& light, std::span<const Bounds> parts, const scene::Camera& camera,
                 int width, int height) {
  const auto points = seenAndLit(light, parts, camera, static_cast<double>(width) / height);
  return points ? pixelsAround(*points, camera, width, height) : -1;
}

std::vector<int> shadowResolutions(std::span<const lights::Light> lights, std::span<const Bounds> parts,
                                   const scene::Camera& camera, int width, int height,
                                   const Quality& quality) {
  constexpr int least = 32;
  std::vector<int> resolutions;
  for (const lights::Light& light : lights) {
    const auto points = light.castsShadow
                            ? seenAndLit(light, parts, camera, static_cast<double>(width) / height)
                            : std::nullopt;
    int& resolution = resolutions.emplace_back(0);
    if (!points) continue;
    const double wanted = pixelsAround(*points, camera, width, height) / pixelsOfFullResolution;
    const double share = quality.exactShadowResolution
                             ? 1
                             : std::min(wanted / std::max(shareOfFace(light, *points), 1e-6), 1.0);
    resolution = std::max(least, static_cast<int>(std::ceil(quality.shadowResolution * share)));
  }
  return resolutions;
}

}  // namespace sfumato::pipelines
