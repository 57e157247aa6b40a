// The whole surface of a fragment, packed for the G-buffer or the camera's lists.
#include "shaders/scene/material.glsl"
#include "shaders/scene/surface_point.glsl"

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

// What the material says of a fragment whose base colour is `base`.
SurfacePoint surfacePoint(vec4 base) {
  MaterialData material = surfaceMaterial();
  vec4 metallicRoughness = materialTexture(metallicRoughnessTexture, TEXTURE_METALLIC_ROUGHNESS);
  SurfacePoint point;
  point.base = base;
  point.metallic = clamp(material.factors.x * metallicRoughness.b, 0.0, 1.0);
  point.roughness = clamp(material.factors.y * metallicRoughness.g, 0.03, 1.0);
  point.specular = material.specularColour.w * materialTexture(specularTexture, TEXTURE_SPECULAR).a;
  point.specularColour = material.specularColour.rgb * materialTexture(specularColourTexture, TEXTURE_SPECULAR_COLOUR).rgb;
  point.emissive = material.emissive.rgb * materialTexture(emissiveTexture, TEXTURE_EMISSIVE).rgb;
  point.tau = transmission();
  point.unlit = (material.flags.x & MATERIAL_UNLIT) != 0;
  point.geometricNormal = geometricNormal();
  point.normal = shadingNormal(material, point.geometricNormal);
  int object = drawIndices().z;
  point.coverageObject = uint(gl_SampleMaskIn[0]) | ((object & SHADOW_NOT_SELF) != 0 ? uint(object) << 16 : 0u);
  return point;
}

PackedSurface packSurface(vec4 base) {
  return packedSurface(surfacePoint(base));
}
