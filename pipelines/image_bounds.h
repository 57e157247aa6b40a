// Where points of the world are on a camera's image.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "scene/scene.h"

namespace sfumato::pipelines {

// In units of the image's height, from its middle, upwards; low > high where there is nothing.
struct ImageBounds {
  glm::dvec2 low;
  glm::dvec2 high;
};

// Of points (metres, world) before the camera.
ImageBounds boundsOnImage(std::span<const glm::dvec3> points, const scene::Camera& camera);

// Of something across the view at that depth (metres).
double imageHeightsPerMetre(double depth, const scene::Camera& camera);

}  // namespace sfumato::pipelines
