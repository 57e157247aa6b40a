// How much of the ambient light gets to an opaque surface of the G-buffer; 1 where SSAO is not defined. It is the number of
// pixels a side for which there is one result.
#include "shaders/pipelines/occlusion.glsl"
#include "shaders/shared/bindings.h"

#ifdef SSAO
layout(binding = TEXTURE_OCCLUSION) uniform usampler2D occlusions;

// At a position of the image, pixels, where a surface is seen whose plane has that normal (world): of the four results
// around it, those of surfaces near its plane count. `radius`: of the occlusion, m.
float accessibilityAt(ViewParams camera, vec2 position, float depth, vec3 normal, float radius) {
  const float SURFACES_APART = 0.01;  // radii
  vec3 p = placeOf(camera, position, depth);
  vec3 n = mat3(camera.viewFromWorld) * normal;
  vec2 place = (position - (float(SSAO / 2) + 0.5)) / float(SSAO);
  vec2 beyond = fract(place);
  float sum = 0.0;
  float weights = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 corner = ivec2(i & 1, i >> 1);
    ivec2 result = clamp(ivec2(floor(place)) + corner, ivec2(0), textureSize(occlusions, 0) - 1);
    Occluded other = unpackOccluded(texelFetch(occlusions, result, 0));
    if (other.depth >= NOTHING_SEEN) continue;
    vec3 there = placeOf(camera, vec2(pixelOfResult(camera, result, SSAO)) + 0.5, other.depth);
    vec2 nearness = mix(1.0 - beyond, beyond, vec2(corner)) + 1e-3;
    float weight = nearness.x * nearness.y / (SURFACES_APART + abs(dot(there - p, n)) / radius);
    sum += weight * other.occlusion;
    weights += weight;
  }
  return weights > 0.0 ? clamp(1.0 - sum / weights, 0.0, 1.0) : 1.0;
}
#else
float accessibilityAt(ViewParams camera, vec2 position, float depth, vec3 normal, float radius) {
  return 1.0;
}
#endif
