// One direction of the separable cross-bilateral blur (Ferko 2012, section 5.2): a Gaussian whose weights fall with the
// distance between surfaces. That is told from the plane of the surface in the middle, not from depths: a floor seen at a
// grazing angle is one surface. And places far apart share nothing, so that small images keep what is dark.
#include "shaders/pipelines/occlusion.glsl"
#include "shaders/shared/bindings.h"
#include "shaders/shared/view_block.glsl"

#define LINE 64
layout(local_size_x = LINE) in;
layout(std140, binding = UNIFORM_PASS) uniform Pass {
  OcclusionParams params;
};
layout(binding = TEXTURE_OCCLUSION) uniform usampler2D unblurred;
layout(rgba32ui, binding = IMAGE_RESULT) writeonly uniform uimage2D results;

const float NO_SURFACE = -1.0;

shared vec4 line[LINE + 2 * OCCLUSION_BLUR_MOST];  // place in the view, occlusion or NO_SURFACE
shared float gaussian[OCCLUSION_BLUR_MOST + 1];

vec4 atResult(ivec2 result) {
  if (any(lessThan(result, ivec2(0))) || any(greaterThanEqual(result, params.size.xy))) return vec4(NO_SURFACE);
  Occluded texel = unpackOccluded(texelFetch(unblurred, result, 0));
  if (texel.depth >= NOTHING_SEEN) return vec4(NO_SURFACE);
  ivec2 pixel = pixelOfResult(view, result, params.size.z);
  return vec4(placeOf(view, vec2(pixel) + 0.5, texel.depth), texel.occlusion);
}

// Results to each side that can be near enough to count.
int stepsWithin(vec3 p, float metres) {
  float spacing = 2.0 * view.halfExtent.y / float(view.size.y) * float(params.size.z);
  if (view.halfExtent.z == 0.0) spacing *= p.z * p.z / length(p);  // of the rays, as p is away from them
  return int(min(ceil(metres / spacing), float(params.size.w)));
}

void main() {
  int reach = params.size.w;
  int number = int(gl_LocalInvocationID.x);
  ivec2 first = ivec2(gl_WorkGroupID.x) * LINE * params.along.xy + ivec2(gl_WorkGroupID.y) * params.along.yx;
  for (int i = number; i < LINE + 2 * reach; i += LINE) line[i] = atResult(first + (i - reach) * params.along.xy);
  for (int i = number; i <= reach; i += LINE) {
    float deviations = 2.0 * float(i) / float(reach);
    gaussian[i] = exp(-0.5 * deviations * deviations);
  }
  barrier();

  ivec2 result = first + number * params.along.xy;
  if (any(greaterThanEqual(result, params.size.xy))) return;
  Occluded middle = unpackOccluded(texelFetch(unblurred, result, 0));
  if (middle.depth < NOTHING_SEEN) {
    vec3 p = line[number + reach].xyz;
    vec3 normal = normalInView(view, middle.normal);
    float sum = 0.0;
    float weights = 0.0;
    int steps = stepsWithin(p, params.distances.x * params.distances.z);
    for (int i = -steps; i <= steps; ++i) {
      vec4 other = line[number + reach + i];
      vec3 apart = (other.xyz - p) / params.distances.x;
      float near = max(1.0 - dot(apart, apart) / (params.distances.z * params.distances.z), 0.0);
      float weight = near * gaussian[abs(i)] / (params.distances.y + abs(dot(apart, normal)));  // equation 3
      if (other.w == NO_SURFACE) weight = 0.0;
      sum += weight * other.w;
      weights += weight;
    }
    middle.occlusion = sum / weights;
  }
  imageStore(results, result, packOccluded(middle));
}
