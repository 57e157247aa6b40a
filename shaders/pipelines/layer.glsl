// A layer of surfaces for readers (pipelines/layers_gpu.h): what is seen at a pixel, how deep, and the light on it.
// TABLE_STORAGE is defined where it is kept in 8 and 10 bits; then no surface emits.
#include "shaders/pipelines/brdf.glsl"
#include "shaders/scene/surface_point.glsl"
#include "shaders/shared/bindings.h"
#include "shaders/shared/layers.h"

layout(binding = TEXTURE_OPAQUE_DEPTH) uniform sampler2D layerDepths;  // NOTHING_SEEN: no surface
#ifdef TABLE_STORAGE
layout(binding = TEXTURE_SURFACE_0) uniform sampler2D layerColour;
layout(binding = TEXTURE_SURFACE_1) uniform sampler2D layerNormal;
layout(binding = TEXTURE_SURFACE_2) uniform sampler2D layerMaterial;
#else
layout(binding = TEXTURE_SURFACE_0) uniform usampler2D layerSurface0;
layout(binding = TEXTURE_SURFACE_1) uniform usampler2D layerSurface1;
layout(binding = TEXTURE_SURFACE_2) uniform usampler2D layerSurface2;
#endif
layout(binding = TEXTURE_LAYER_LIGHT) uniform sampler2D layerLight;  // see layerRadiance

float layerDepth(ivec2 pixel) {
  return texelFetch(layerDepths, pixel, 0).r;
}

#ifdef TABLE_STORAGE
SurfacePoint layerPoint(ivec2 pixel) {
  vec4 colour = texelFetch(layerColour, pixel, 0);
  vec4 normal = texelFetch(layerNormal, pixel, 0);
  vec4 material = texelFetch(layerMaterial, pixel, 0);
  SurfacePoint point;
  point.base = vec4(colour.rgb * colour.rgb, colour.a);
  point.normal = point.geometricNormal = normalize(normal.xyz * 2.0 - 1.0);
  point.specular = material.r;
  point.specularColour = vec3(1.0);
  point.roughness = max(material.g, 0.03);
  point.metallic = material.b;
  point.tau = material.a;
  point.emissive = vec3(0.0);
  point.unlit = false;
  point.coverageObject = normal.w > 0.5 ? LAYER_TRANSLUCENT : 0u;
  return point;
}

PackedSurface layerSurface(ivec2 pixel) {
  return packedSurface(layerPoint(pixel));
}

// Light is kept apart from the colours that it meets: irradiance over pi, and what is reflected like in a mirror, white
// (Aladagli 2015, table 3.2).
vec3 layerRadiance(ivec2 pixel) {
  SurfacePoint point = layerPoint(pixel);
  vec4 light = texelFetch(layerLight, pixel, 0);
  vec3 diffuse = point.base.rgb * ((1.0 - point.metallic) * point.base.a * (1.0 - point.tau));
  return diffuse * light.rgb + light.a;
}
#else
PackedSurface layerSurface(ivec2 pixel) {
  uvec4 a = texelFetch(layerSurface0, pixel, 0);
  uvec4 b = texelFetch(layerSurface1, pixel, 0);
  uvec2 c = texelFetch(layerSurface2, pixel, 0).xy;
  return PackedSurface(a.x, a.y, a.z, a.w, b.x, b.y, b.z, b.w, c.x, c.y);
}

vec3 layerRadiance(ivec2 pixel) {
  return texelFetch(layerLight, pixel, 0).rgb;
}
#endif

bool isTranslucent(PackedSurface surface) {
  return (surface.coverageObject & LAYER_TRANSLUCENT) != 0u;
}

// Of what is behind, per channel; nothing behind a surface that is opaque.
vec3 layerPass(PackedSurface surface) {
  return isTranslucent(surface) ? surfacePass(surface) : vec3(0.0);
}

bool isTranslucentAt(ivec2 pixel) {
  return isTranslucent(layerSurface(pixel));
}

vec3 passAt(ivec2 pixel) {
  return surfacePass(layerSurface(pixel));
}

vec3 normalAt(ivec2 pixel) {
  return unpackSurface(layerSurface(pixel)).normal;
}
