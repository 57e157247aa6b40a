#include "lights/light_reach.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sfumato::lights {

double reach(const Light& light) {
  if (light.type == LightType::Directional) return std::numeric_limits<double>::infinity();
  const double brightest = std::max({light.intensity.r, light.intensity.g, light.intensity.b});
  return std::min(light.range, std::sqrt(brightest / irradianceCutoff));
}

bool reaches(const Light& light, const glm::dvec3& pWorld) {
  if (light.type == LightType::Directional) return true;
  const glm::dvec3 away = pWorld - light.position;
  const double distance = glm::length(away);
  if (distance > reach(light)) return false;
  if (light.type == LightType::Point || distance == 0) return true;
  return glm::dot(away / distance, light.direction) >= std::cos(light.outerCone);
}

std::vector<int> lightOrder(const std::vector<Light>& lights) {
  std::vector<int> order;
  for (const LightType type : {LightType::Directional, LightType::Point, LightType::Spot}) {
    for (size_t i = 0; i < lights.size(); ++i) {
      const bool dark = glm::dot(lights[i].intensity, glm::dvec3(1.0)) <= 0 || reach(lights[i]) <= 0;
      if (lights[i].type == type && !dark) order.push_back(static_cast<int>(i));
    }
  }
  return order;
}

}  // namespace sfumato::lights
