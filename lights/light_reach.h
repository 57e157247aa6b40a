// How far lights reach, and in which order they stand.
#pragma once

#include <vector>

#include "lights/light.h"

namespace sfumato::lights {

// A light without a range ends where its irradiance falls below this, W/m^2 (radiometric units of DESIGN: a
// picture is exposed for about 1).
constexpr double irradianceCutoff = 1e-4;

// Distance in metres beyond which the light gives nothing (its range), or less than the cutoff. Infinite for
// directional lights.
double reach(const Light& light);

// Whether the light gives anything at a point, shadows aside: inside its reach and its cone.
bool reaches(const Light& light, const glm::dvec3& pWorld);

// Indices of the lights that give anything at all: directional ones first, then point, then spot, each in
// file order.
std::vector<int> lightOrder(const std::vector<Light>& lights);

}  // namespace sfumato::lights
