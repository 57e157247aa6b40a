// Tessellated surfaces of as many triangles as are asked for.
#pragma once

#include <cstddef>
#include <functional>
#include <glm/glm.hpp>

#include "scene/scene.h"

namespace sfumato::scene {

// A point of the world for u and v in [0, 1], and a little beyond, where normals are taken.
using SurfacePoint = std::function<glm::dvec3(double u, double v)>;

// The surface in exactly `triangles` (at least 2) triangles, without gaps; seen from where cross(dP/du,
// dP/dv) points to. `aspect`: about how long it is along u over along v, so that triangles are about as wide
// as high. Throws Bug for fewer triangles.
Mesh tessellated(const SurfacePoint& point, size_t triangles, double aspect = 1);

}  // namespace sfumato::scene
