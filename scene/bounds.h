// Boxes along the axes of the world.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "scene/scene.h"
#include "volumes/grid.h"

namespace sfumato::scene {

// An axis-aligned box in the world.
struct Bounds {
  glm::dvec3 low{infinity};
  glm::dvec3 high{-infinity};

  bool empty() const { return !(low.x <= high.x); }
  glm::dvec3 centre() const { return (low + high) * 0.5; }
  double radius() const { return glm::length(high - low) * 0.5; }  // of the sphere around it
};

Bounds boundsOf(std::span<const glm::dvec3> points);
Bounds boundsOf(std::span<const volumes::Medium> media);  // of their boxes
// Bit 0 of `which` chooses the high x, bit 1 y, bit 2 z.
glm::dvec3 corner(const Bounds& bounds, int which);
// The box as the image of the unit cube.
glm::dmat4 worldFromUnit(const Bounds& bounds);

}  // namespace sfumato::scene
