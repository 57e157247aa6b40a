// What the deep shadow map of each light looks through.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "deepshadow/shadow_faces.h"
#include "lights/light.h"

namespace sfumato::scene {

// Whether a spot's cone is narrow enough for one face.
bool isNarrowSpot(const lights::Light& light);
int faceCount(const lights::Light& light);  // 1, or 6 of a cube

// The faces of a light at a resolution; wide spots get those of a point light. See shadow_faces.h.
std::vector<deepshadow::FaceProjection> facesOf(const lights::Light& light, int resolution,
                                                std::span<const glm::dvec3> receivers,
                                                std::span<const glm::dvec3> castingPoints);

}  // namespace sfumato::scene
