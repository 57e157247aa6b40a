// Tells the rays that meet surfaces, which are to be walked, from those that none stops, and gives these what they see: the
// smoke that blocks of pixels marched, or nothing. Apart, because some drivers run the code of surfaces for every ray.
// SMOKE_BLOCKS: see resolve.comp.
#include "shaders/lists/runs.glsl"
#include "shaders/pipelines/rays.glsl"
#include "shaders/shared/linear_id.glsl"
#include "shaders/shared/tiled_order.glsl"
#ifdef SMOKE_BLOCKS
#include "shaders/pipelines/smoke_blocks.glsl"
#endif

layout(std430, binding = STORAGE_WALKED_RAYS) writeonly buffer WalkedRays {
  uint walkedRays[];
};
layout(std430, binding = STORAGE_COUNTERS) buffer Counting {
  ResolveCounters counters;
};

void main() {
  uint number = linearId();
  if (number >= uint(params.options.w)) return;
  if (number < uint(view.window.z * view.window.w)) number = inTiles(number, view.window.zw);
  RayPlace place = rayPlace(number);
  float opaque = texelFetch(opaqueDepth, place.pixel - view.tile.xy, place.number).r;
  if (place.split || opaque < view.depthRange.y || listRun(listOfPixel(view, place.pixel)).count != 0u) {
    walkedRays[atomicAdd(counters.groups, 1u)] = number;
    return;
  }
  vec3 radiance = vec3(0.0);
  vec3 passed = vec3(1.0);
#ifdef SMOKE_BLOCKS
  SmokeSeen seen = blockTaps(vec2(place.pixel) + 0.5, SMOKE_ENDLESS, false).whole;
  radiance = seen.radiance;
  passed = seen.passed;
#endif
  keepSeen(number, radiance, passed);
#ifdef COUNT_LOOKUPS
  rayLookups[number] = uvec4(0u);
#endif
}
