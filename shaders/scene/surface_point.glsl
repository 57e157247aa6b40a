// A point of a surface as its material describes it, and what light makes of it.
#include "shaders/scene/pass_through.glsl"
#include "shaders/shared/math.glsl"
#include "shaders/shared/surface.h"

struct SurfacePoint {
  vec4 base;  // linear colour; alpha: coverage
  float metallic;
  float roughness;
  float specular;
  vec3 specularColour;
  vec3 emissive;
  float tau;   // transmission
  bool unlit;  // its colour is what it emits
  vec3 normal;
  vec3 geometricNormal;
  uint coverageObject;  // see PackedSurface
};

PackedSurface packedSurface(SurfacePoint point) {
  vec4 base = point.base;
  vec3 emissive = point.emissive * base.a;
  vec3 diffuse = base.rgb * ((1.0 - point.metallic) * base.a * (1.0 - point.tau));
  vec3 f0 = mix(min(0.04 * point.specularColour, 1.0) * point.specular, base.rgb, point.metallic) * base.a;
  float f90 = mix(point.specular, 1.0, point.metallic) * base.a;
  if (point.unlit) {
    emissive = base.rgb * base.a;
    diffuse = f0 = vec3(0.0);
    f90 = 0.0;
  }
  vec3 pass = passThrough(base, point.tau);
  PackedSurface s;
  s.normal = packSnorm2x16(octahedralFromUnit(point.normal));
  s.geometricNormal = packSnorm2x16(octahedralFromUnit(point.geometricNormal));
  s.diffuseRg = packHalf2x16(diffuse.rg);
  s.diffuseBRoughness = packHalf2x16(vec2(diffuse.b, point.roughness));
  s.f0Rg = packHalf2x16(f0.rg);
  s.f0BF90 = packHalf2x16(vec2(f0.b, f90));
  s.emissiveRg = packHalf2x16(min(emissive.rg, 65504.0));
  s.emissiveBPassR = packHalf2x16(vec2(min(emissive.b, 65504.0), pass.r));
  s.passGb = packHalf2x16(pass.gb);
  s.coverageObject = (point.coverageObject & 0xffff000fu) | uint(round(4095.0 * (1.0 - clamp(base.a, 0.0, 1.0)))) << 4;
  return s;
}
