// The rays of a window's pixels and of their samples: see shaders/shared/resolve.h.
#include "shaders/pipelines/camera_ray.glsl"
#include "shaders/pipelines/pixel_groups.glsl"
#include "shaders/shared/bindings.h"
#include "shaders/shared/division.glsl"
#include "shaders/shared/resolve_block.glsl"
#include "shaders/shared/view_block.glsl"

// Of each ray its radiance, then, where TRANSMITTANCE is defined, of each how much passes all that it met.
layout(std430, binding = STORAGE_SEEN) writeonly buffer Seen {
  float seenByRays[];
};
layout(binding = TEXTURE_OPAQUE_DEPTH) uniform pixelSampler opaqueDepth;

#ifdef COUNT_LOOKUPS
layout(std430, binding = STORAGE_LOOKUPS) buffer RayLookups {
  uvec4 rayLookups[];  // x: lights asked, y: shadows, z: steps in smoke looked at, w: jumped over
};
#endif

void keepSeen(uint ray, vec3 radiance, vec3 passed) {
  for (uint c = 0u; c < 3u; ++c) {
    seenByRays[3u * ray + c] = radiance[c];
#ifdef TRANSMITTANCE
    seenByRays[uint(seenByRays.length()) / 2u + 3u * ray + c] = passed[c];
#endif
  }
}

// Which pixel and which of its samples a ray goes through; `split`: the pixel's samples have a ray each.
struct RayPlace {
  ivec2 pixel;  // of the image
  int number;  // of the sample
  bool split;
};

RayPlace rayPlace(uint ray) {
  uint pixels = uint(view.window.z * view.window.w);
  uint pixel = ray;
  int number = 0;
  bool split = false;
  if (ray < pixels) split = isSplit(ray);
#if SAMPLES > 1
  if (ray >= pixels) {
    pixel = pixelGroups[pixels + (ray - pixels) / uint(SAMPLES - 1)];
    number = 1 + int((ray - pixels) % uint(SAMPLES - 1));
    split = true;
  }
#endif
  ivec2 place = placeInRows(pixel, view.window.z);
  return RayPlace(view.window.xy + place, number, split);
}
