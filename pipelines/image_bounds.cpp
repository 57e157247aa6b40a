#include "pipelines/image_bounds.h"

#include <algorithm>
#include <cmath>

#include "scene/bounds.h"

namespace sfumato::pipelines {

using glm::dvec2;
using glm::dvec3;

double imageHeightsPerMetre(double depth, const scene::Camera& camera) {
  if (camera.orthographic) return 1 / (2 * camera.yMagnitude);
  return 1 / (2 * std::tan(camera.yfov / 2) * std::max(depth, 1e-12));
}

ImageBounds boundsOnImage(std::span<const dvec3> points, const scene::Camera& camera) {
  const glm::dmat4 viewFromWorld = glm::inverse(camera.worldFromView);
  ImageBounds bounds{dvec2(scene::infinity), dvec2(-scene::infinity)};
  for (const dvec3& pWorld : points) {
    const dvec3 p(viewFromWorld * glm::dvec4(pWorld, 1));
    const dvec2 place = dvec2(p) * imageHeightsPerMetre(-p.z, camera);
    bounds.low = glm::min(bounds.low, place);
    bounds.high = glm::max(bounds.high, place);
  }
  return bounds;
}

}  // namespace sfumato::pipelines
