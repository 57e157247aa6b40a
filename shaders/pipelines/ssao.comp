// Screen-space ambient occlusion (Ferko 2012, section 5.1; Mittring 2007): points around what a pixel shows are looked for
// in the depth buffer. Those that something hides tell of a surface near by, which takes ambient light away.
#include "shaders/pipelines/occlusion.glsl"
#include "shaders/shared/bindings.h"
#include "shaders/shared/hash.glsl"
#include "shaders/shared/view_block.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(std140, binding = UNIFORM_PASS) uniform Pass {
  OcclusionParams params;
};
layout(binding = TEXTURE_OPAQUE_DEPTH) uniform sampler2D opaqueDepth;
layout(binding = TEXTURE_SURFACE_0) uniform usampler2D opaqueSurface0;
layout(rgba32ui, binding = IMAGE_RESULT) writeonly uniform uimage2D results;

// What stands lower over the plane than this, as a sine, is the surface itself: neither a plane nor its facets' rounding
// occludes itself.
const float LOWEST = 0.02;
const float ROUNDING = 2e-5;  // of depths

vec3 randomUnit(ivec2 place) {
  uint bits = hash(uint(place.x) + hash(uint(place.y)));
  float z = float(bits & 0xffffu) / 32768.0 - 1.0;
  float angle = float(bits >> 16) / 65536.0 * 2.0 * PI;
  return vec3(sqrt(max(1.0 - z * z, 0.0)) * vec2(cos(angle), sin(angle)), z);
}

// Of what is at a distance, radii: equation 2, 1 / (1 + d^2), times 1 - d^4, so that it ends at the radius, and what is far
// in front has no halo.
float weightAt(float d) {
  return max(1.0 - d * d, 0.0);
}

// How much of the light around a surface point another one takes, if it is what hides a point near by.
float occlusionBy(vec3 p, vec3 normal, vec3 other) {
  vec3 apart = other - p;
  float metres = length(apart);
  if (dot(apart, normal) <= LOWEST * metres + ROUNDING * max(-p.z, 0.0)) return 0.0;
  return weightAt(metres / params.distances.x);
}

void main() {
  ivec2 result = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(result, params.size.xy))) return;
  ivec2 pixel = pixelOfResult(view, result, params.size.z);
  Occluded found = Occluded(0.0, texelFetch(opaqueDepth, pixel, 0).r, texelFetch(opaqueSurface0, pixel, 0).y);
  if (found.depth < NOTHING_SEEN) {
    vec3 p = placeOf(view, vec2(pixel) + 0.5, found.depth);
    vec3 normal = normalInView(view, found.normal);
    vec3 mirror = randomUnit(result);
    float occlusion = 0.0;
    float most = 0.0;  // were every point hidden where it is
    for (int i = 0; i < OCCLUSION_SAMPLES; ++i) {
      vec3 offset = reflect(params.offsets[i].xyz, mirror);
      most += weightAt(length(offset));
      if (dot(offset, normal) < 0.0) offset = -offset;
      vec3 q = p + params.distances.x * offset;
      float depth = -q.z;
      vec2 seenAt = depth > view.depthRange.x ? positionOf(view, q) : vec2(-1.0);
      if (any(lessThan(seenAt, vec2(0.0))) || any(greaterThanEqual(seenAt, vec2(view.size.xy)))) continue;
      float hiding = texelFetch(opaqueDepth, ivec2(seenAt), 0).r;
      if (hiding < depth) occlusion += occlusionBy(p, normal, placeOf(view, floor(seenAt) + 0.5, hiding));
    }
    found.occlusion = min(occlusion / most, 1.0);
  }
  imageStore(results, result, packOccluded(found));
}
