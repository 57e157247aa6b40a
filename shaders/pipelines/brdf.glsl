// The metallic-roughness surface of glTF: Lambert and GGX, unpacked from PackedSurface.
#include "shaders/shared/math.glsl"
#include "shaders/shared/surface.h"

struct Surface {
  vec3 normal;
  vec3 geometricNormal;
  vec3 diffuse;
  float roughness;
  vec3 f0;
  float f90;
  float perAlpha;  // 1 / alpha, by which the colours above are multiplied
  vec3 emissive;
  uint object;  // see PackedSurface
};

Surface unpackSurface(PackedSurface s) {
  Surface surface;
  vec2 diffuseB = unpackHalf2x16(s.diffuseBRoughness);
  vec2 f0B = unpackHalf2x16(s.f0BF90);
  surface.normal = unitFromOctahedral(unpackSnorm2x16(s.normal));
  surface.geometricNormal = unitFromOctahedral(unpackSnorm2x16(s.geometricNormal));
  surface.diffuse = vec3(unpackHalf2x16(s.diffuseRg), diffuseB.x);
  surface.roughness = diffuseB.y;
  surface.f0 = vec3(unpackHalf2x16(s.f0Rg), f0B.x);
  surface.f90 = f0B.y;
  surface.perAlpha = 4095.0 / max(float(4095u - (s.coverageObject >> 4 & 4095u)), 0.5);
  surface.emissive = vec3(unpackHalf2x16(s.emissiveRg), unpackHalf2x16(s.emissiveBPassR).x);
  surface.object = s.coverageObject >> 16;
  return surface;
}

vec3 surfacePass(PackedSurface s) {
  return vec3(unpackHalf2x16(s.emissiveBPassR).y, unpackHalf2x16(s.passGb));
}

// The part of what arrives that is not mirrored: alpha takes from both alike.
float notMirrored(Surface surface, vec3 mirrored) {
  return 1.0 - clamp(maxComponent(mirrored) * surface.perAlpha, 0.0, 1.0);
}

// Reflected radiance over irradiance, 1/sr, in two parts: what is mirrored, by GGX with height-correlated Smith visibility
// (glTF 2.0, appendix B), and, as the result, what multiplies the diffuse colour.
float brdfParts(Surface surface, vec3 toLight, vec3 toViewer, out vec3 mirrored) {
  vec3 halfway = normalize(toLight + toViewer);
  float nl = max(dot(surface.normal, toLight), 1e-5);
  float nv = max(dot(surface.normal, toViewer), 1e-5);
  float nh = clamp(dot(surface.normal, halfway), 0.0, 1.0);
  float vh = clamp(dot(toViewer, halfway), 0.0, 1.0);
  float alpha = surface.roughness * surface.roughness;
  float a2 = alpha * alpha;
  float d = nh * nh * (a2 - 1.0) + 1.0;
  float distribution = a2 / (PI * d * d);
  float visibility = 0.5 / (nl * sqrt(nv * nv * (1.0 - a2) + a2) + nv * sqrt(nl * nl * (1.0 - a2) + a2));
  float grazing = pow(1.0 - vh, 5.0);
  vec3 fresnel = surface.f0 + (surface.f90 - surface.f0) * grazing;
  mirrored = distribution * visibility * fresnel;
  return notMirrored(surface, fresnel) / PI;
}

vec3 brdf(Surface surface, vec3 toLight, vec3 toViewer) {
  vec3 mirrored;
  float scattered = brdfParts(surface, toLight, toViewer, mirrored);
  return surface.diffuse * scattered + mirrored;
}
