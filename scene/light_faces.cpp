#include "scene/light_faces.h"

namespace sfumato::scene {

bool isNarrowSpot(const lights::Light& light) {
  return light.type == lights::LightType::Spot && light.outerCone <= deepshadow::widestCone;
}

int faceCount(const lights::Light& light) {
  return light.type == lights::LightType::Directional || isNarrowSpot(light) ? 1 : 6;
}

std::vector<deepshadow::FaceProjection> facesOf(const lights::Light& light, int resolution,
                                                std::span<const glm::dvec3> receivers,
                                                std::span<const glm::dvec3> castingPoints) {
  const int side = deepshadow::faceSide(resolution);
  if (light.type == lights::LightType::Directional)
    return {deepshadow::directionalFace(light.direction, side, receivers, castingPoints)};
  if (isNarrowSpot(light))
    return {deepshadow::coneFace(light.position, light.direction, light.outerCone, side)};
  return deepshadow::cubeFaces(light.position, side);
}

}  // namespace sfumato::scene
