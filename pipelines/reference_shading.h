// Materials and lights of the reference, in double precision: glTF's metallic-roughness model (appendix B of
// its specification) with KHR_materials_specular, KHR_materials_transmission and KHR_lights_punctual.
#pragma once

#include <array>
#include <glm/glm.hpp>

#include "scene/scene.h"

namespace sfumato::pipelines {

// What a triangle's corners say about a point of it, in world space.
struct SurfacePoint {
  glm::dvec3 position{0.0};
  glm::dvec3 geometricNormal{0, 0, 1};  // unit, towards the viewer
  glm::dvec3 normal{0, 0, 1};           // unit, interpolated; on the side that the file gives it
  glm::dvec4 tangent{1, 0, 0, 1};       // direction, w: handedness of the bitangent
  std::array<glm::dvec2, 2> uv{};
  glm::dvec4 colour{1.0};
};

// How much of a surface is there: base colour b, alpha a (0 where MASK cuts), transmission tau.
struct Coverage {
  glm::dvec3 baseColour{1.0};
  double alpha = 1;
  double transmission = 0;

  // What passes, per channel: t = 1 - a (1 - tau b). Exactly 0 for an opaque surface.
  glm::dvec3 passing() const { return 1.0 - alpha * (1.0 - transmission * baseColour); }
};

Coverage coverageAt(const scene::Scene& scene, const scene::Material& material, const SurfacePoint& point);

// What a surface sends back of light that arrives at it.
struct Reflector {
  glm::dvec3 normal{0, 0, 1};  // unit, shading, on the viewer's side
  glm::dvec3 diffuse{0.0};     // albedo d = b (1 - metallic) a (1 - tau)
  double alpha = 1;            // weighs the specular lobe
  double roughness = 1;        // in [0.03, 1]; GGX has its square
  glm::dvec3 specular0{0.0};   // F0
  double specular90 = 1;       // F90
  glm::dvec3 emitted{0.0};     // radiance
};

Reflector reflectorAt(const scene::Scene& scene, const scene::Material& material, const SurfacePoint& point,
                      const Coverage& coverage);

// f = d / pi * (1 - max F) + a D V F, 1/sr; 0 where the light is behind the shading normal. Unit directions
// away from the surface.
glm::dvec3 brdf(const Reflector& reflector, const glm::dvec3& toViewer, const glm::dvec3& toLight);

// What comes back of a radiance of 1 from all around, per channel: d (1 - max F0) + a F0.
glm::dvec3 ambientAlbedo(const Reflector& reflector);

// A light as a point sees it, shadows aside.
struct Illumination {
  glm::dvec3 toLight{0, 0, 1};  // unit
  double distance = 0;          // metres, infinite for a directional light
  glm::dvec3 irradiance{0.0};   // of a plane that faces the light, W/m^2
};

Illumination illuminate(const scene::Light& light, const glm::dvec3& pWorld);

// A texture at level 0, u to the right and v down, in [0, 1] across it: bilinear, or nearest where the
// texture says so. RGB is decoded from sRGB before filtering if `srgb`.
glm::dvec4 sampleTexture(const scene::Texture& texture, const glm::dvec2& uv, bool srgb);

}  // namespace sfumato::pipelines
