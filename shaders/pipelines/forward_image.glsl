// What a forward renderer leaves of the surfaces that it lit, for readers; as in layer.glsl.
#include "shaders/shared/bindings.h"

layout(binding = TEXTURE_OPAQUE_DEPTH) uniform sampler2D layerDepths;
layout(binding = TEXTURE_SURFACE_0) uniform sampler2D layerPasses;   // rgb: what is let through; a: 1 where translucent
layout(binding = TEXTURE_SURFACE_1) uniform sampler2D layerNormals;  // world, from [0, 1]
layout(binding = TEXTURE_LAYER_LIGHT) uniform sampler2D layerLight;  // radiance

float layerDepth(ivec2 pixel) {
  return texelFetch(layerDepths, pixel, 0).r;
}

vec3 layerRadiance(ivec2 pixel) {
  return texelFetch(layerLight, pixel, 0).rgb;
}

bool isTranslucentAt(ivec2 pixel) {
  return texelFetch(layerPasses, pixel, 0).a > 0.5;
}

vec3 passAt(ivec2 pixel) {
  return texelFetch(layerPasses, pixel, 0).rgb;
}

vec3 normalAt(ivec2 pixel) {
  return normalize(texelFetch(layerNormals, pixel, 0).xyz * 2.0 - 1.0);
}
