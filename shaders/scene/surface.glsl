// The whole surface of a fragment, packed for the G-buffer or the camera's lists.
#include "shaders/scene/material.glsl"
#include "shaders/shared/math.glsl"
#include "shaders/shared/surface.h"

layout(binding = TEXTURE_METALLIC_ROUGHNESS) uniform sampler2D metallicRoughnessTexture;
layout(binding = TEXTURE_NORMAL) uniform sampler2D normalTexture;
layout(binding = TEXTURE_EMISSIVE) uniform sampler2D emissiveTexture;
layout(binding = TEXTURE_SPECULAR) uniform sampler2D specularTexture;
layout(binding = TEXTURE_SPECULAR_COLOUR) uniform sampler2D specularColourTexture;

// The triangle's normal in world space, turned towards the viewer.
vec3 geometricNormal() {
  vec3 nView = normalize(cross(dFdx(vPositionView), dFdy(vPositionView)));
  vec3 toViewer = view.halfExtent.z != 0.0 ? vec3(0.0, 0.0, 1.0) : -vPositionView;
  if (dot(nView, toViewer) < 0.0) nView = -nView;
  return mat3(view.worldFromView) * nView;
}

// The side is that of the interpolated normal; a normal map may lean behind the triangle's plane.
vec3 shadingNormal(MaterialData material, vec3 geometric) {
  vec3 n = normalize(vNormalWorld);
  float side = dot(n, geometric) < 0.0 ? -1.0 : 1.0;
  vec3 m = materialTexture(normalTexture, TEXTURE_NORMAL).xyz * 2.0 - 1.0;  // before the flow diverges
  if ((material.flags.x & MATERIAL_NORMAL_MAP) != 0) {
    vec3 t = normalize(vTangentWorld.xyz - n * dot(n, vTangentWorld.xyz));
    vec3 b = cross(n, t) * vTangentWorld.w;
    m.xy *= material.factors.z;
    n = normalize(mat3(t, b, n) * m);
  }
  return side * n;
}

PackedSurface packSurface(vec4 base) {
  MaterialData material = materials[materialNumber()];
  vec4 metallicRoughness = materialTexture(metallicRoughnessTexture, TEXTURE_METALLIC_ROUGHNESS);
  float metallic = clamp(material.factors.x * metallicRoughness.b, 0.0, 1.0);
  float roughness = clamp(material.factors.y * metallicRoughness.g, 0.03, 1.0);
  float specular = material.specularColour.w * materialTexture(specularTexture, TEXTURE_SPECULAR).a;
  vec3 specularColour = material.specularColour.rgb * materialTexture(specularColourTexture, TEXTURE_SPECULAR_COLOUR).rgb;
  vec3 emissive = material.emissive.rgb * materialTexture(emissiveTexture, TEXTURE_EMISSIVE).rgb * base.a;
  float tau = transmission();

  vec3 diffuse = base.rgb * ((1.0 - metallic) * base.a * (1.0 - tau));
  vec3 f0 = mix(min(0.04 * specularColour, 1.0) * specular, base.rgb, metallic) * base.a;
  float f90 = mix(specular, 1.0, metallic) * base.a;
  if ((material.flags.x & MATERIAL_UNLIT) != 0) {
    emissive = base.rgb * base.a;
    diffuse = f0 = vec3(0.0);
    f90 = 0.0;
  }
  vec3 pass = passThrough(base, tau);
  vec3 geometric = geometricNormal();
  int object = draws[vDraw].indices.z;

  PackedSurface s;
  s.normal = packSnorm2x16(octahedralFromUnit(shadingNormal(material, geometric)));
  s.geometricNormal = packSnorm2x16(octahedralFromUnit(geometric));
  s.diffuseRg = packHalf2x16(diffuse.rg);
  s.diffuseBRoughness = packHalf2x16(vec2(diffuse.b, roughness));
  s.f0Rg = packHalf2x16(f0.rg);
  s.f0BF90 = packHalf2x16(vec2(f0.b, f90));
  s.emissiveRg = packHalf2x16(min(emissive.rg, 65504.0));
  s.emissiveBPassR = packHalf2x16(vec2(min(emissive.b, 65504.0), pass.r));
  s.passGb = packHalf2x16(pass.gb);
  s.coverageObject = uint(gl_SampleMaskIn[0]) | ((object & SHADOW_NOT_SELF) != 0 ? uint(object) << 16 : 0u);
  return s;
}
