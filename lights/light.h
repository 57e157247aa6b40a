// Light types, as plain values: KHR_lights_punctual with plain radiometric units (no 683 lm/W factor).
#pragma once

#include <glm/glm.hpp>
#include <limits>
#include <string>

namespace sfumato::lights {

enum class LightType { Directional = 0, Point = 1, Spot = 2 };

struct Light {
  std::string name;
  LightType type = LightType::Point;
  glm::dvec3 position{0.0};        // world
  glm::dvec3 direction{0, 0, -1};  // world, unit: where a directional or spot light shines to
  glm::dvec3 intensity{1.0};       // colour * intensity: W/m^2 for directional, W/sr for point and spot
  double range =
      std::numeric_limits<double>::infinity();  // metres; the window of KHR_lights_punctual where finite
  double innerCone = 0;                         // radians, spot: 0 <= inner < outer <= pi/2
  double outerCone = 0.785398163397448;
  bool castsShadow = true;
};

}  // namespace sfumato::lights
