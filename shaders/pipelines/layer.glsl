// A layer of surfaces for readers (pipelines/layers_gpu.h): what is seen at a pixel, how deep, and the light on it.
// TABLE_STORAGE is defined where it is kept in 8 and 10 bits; then no surface emits. ROUTED is defined where all fragments of
// a pixel are kept in samples, without light (pipelines/stencil_routed_gpu.h).
#include "shaders/pipelines/brdf.glsl"
#include "shaders/scene/surface_point.glsl"
#include "shaders/shared/bindings.h"
#include "shaders/shared/layers.h"

#ifdef ROUTED
#define LayerPlace ivec4  // x, y, layer, sample
#if ROUTED_SAMPLES > 1
#define layerSampler sampler2DMSArray
#define layerUsampler usampler2DMSArray
#else
#define layerSampler sampler2DArray
#define layerUsampler usampler2DArray
#endif
#define layerTexel(image, place) texelFetch(image, place.xyz, place.w)
#else
#define LayerPlace ivec2
#define layerSampler sampler2D
#define layerUsampler usampler2D
#define layerTexel(image, place) texelFetch(image, place, 0)
#endif

#ifdef TABLE_STORAGE
layout(binding = TEXTURE_SURFACE_0) uniform layerSampler layerColour;
layout(binding = TEXTURE_SURFACE_1) uniform layerSampler layerNormal;
layout(binding = TEXTURE_SURFACE_2) uniform layerSampler layerMaterial;
#else
layout(binding = TEXTURE_SURFACE_0) uniform layerUsampler layerSurface0;
layout(binding = TEXTURE_SURFACE_1) uniform layerUsampler layerSurface1;
layout(binding = TEXTURE_SURFACE_2) uniform layerUsampler layerSurface2;
#endif
#ifndef ROUTED
layout(binding = TEXTURE_OPAQUE_DEPTH) uniform sampler2D layerDepths;  // NOTHING_SEEN: no surface
layout(binding = TEXTURE_LAYER_LIGHT) uniform sampler2D layerLight;    // see layerRadiance

float layerDepth(ivec2 pixel) {
  return texelFetch(layerDepths, pixel, 0).r;
}
#endif

#ifdef TABLE_STORAGE
SurfacePoint layerPoint(LayerPlace place) {
  vec4 colour = layerTexel(layerColour, place);
  vec4 normal = layerTexel(layerNormal, place);
  vec4 material = layerTexel(layerMaterial, place);
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

PackedSurface layerSurface(LayerPlace place) {
  return packedSurface(layerPoint(place));
}

#ifndef ROUTED
// Light is kept apart from the colours that it meets: irradiance over pi, and what is reflected like in a mirror, white
// (Aladagli 2015, table 3.2).
vec3 layerRadiance(ivec2 pixel) {
  SurfacePoint point = layerPoint(pixel);
  vec4 light = texelFetch(layerLight, pixel, 0);
  vec3 diffuse = point.base.rgb * ((1.0 - point.metallic) * point.base.a * (1.0 - point.tau));
  return diffuse * light.rgb + light.a;
}
#endif
#else
PackedSurface layerSurface(LayerPlace place) {
  uvec4 a = layerTexel(layerSurface0, place);
  uvec4 b = layerTexel(layerSurface1, place);
  uvec2 c = layerTexel(layerSurface2, place).xy;
  return PackedSurface(a.x, a.y, a.z, a.w, b.x, b.y, b.z, b.w, c.x, c.y);
}

#ifndef ROUTED
vec3 layerRadiance(ivec2 pixel) {
  return texelFetch(layerLight, pixel, 0).rgb;
}
#endif
#endif

bool isTranslucent(PackedSurface surface) {
  return (surface.coverageObject & LAYER_TRANSLUCENT) != 0u;
}

// Of what is behind, per channel; nothing behind a surface that is opaque.
vec3 layerPass(PackedSurface surface) {
  return isTranslucent(surface) ? surfacePass(surface) : vec3(0.0);
}

bool isTranslucentAt(LayerPlace place) {
  return isTranslucent(layerSurface(place));
}

vec3 passAt(LayerPlace place) {
  return surfacePass(layerSurface(place));
}

vec3 normalAt(LayerPlace place) {
  return unpackSurface(layerSurface(place)).normal;
}
