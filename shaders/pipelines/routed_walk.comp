// Takes the rays of a part of the image (view.tile) past all its translucent surfaces, which stand in samples in the order
// in which they were drawn: picks the nearest one that was not met yet, marches there, lights it, goes on. Fragment n of a
// pixel is in layer n / ROUTED_SAMPLES. A ray that has done much work goes on in the next dispatch.
#define ROUTED
#include "shaders/pipelines/camera_ray.glsl"
#include "shaders/pipelines/layer.glsl"
#include "shaders/pipelines/surface_lighting.glsl"
#include "shaders/shared/linear_id.glsl"
// Last: what it includes, it includes only where there is smoke.
#include "shaders/pipelines/smoke_segment.glsl"

layout(std430, binding = STORAGE_RAYS) buffer Rays {
  RayState rays[];
};
layout(std430, binding = STORAGE_ROUTED_MET) buffer Met {
  uvec2 lastMet[];
};
layout(binding = TEXTURE_ROUTED_COUNTS) uniform sampler2D counts;
layout(binding = TEXTURE_ROUTED_KEYS) uniform layerUsampler keys;

ivec4 placeOf(ivec2 pixel, uint fragment) {
  return ivec4(pixel, fragment / uint(ROUTED_SAMPLES), fragment % uint(ROUTED_SAMPLES));
}

// By depth, which is positive, then by number.
bool isBefore(uvec2 a, uvec2 b) {
  return a.x < b.x || (a.x == b.x && a.y < b.y);
}

void main() {
  uint number = linearId();
  if (number >= uint(params.options.w)) return;
  ivec2 place = placeInRows(number, view.tile.z);
  ivec2 pixel = place + view.tile.xy;
  int rayNumber = pixel.y * view.size.x + pixel.x;
  uint count = uint(texelFetch(counts, pixel, 0).r);
  Walker walker = walkerOf(rays[rayNumber]);
  if (walker.ended || walker.layers >= count) return;
  uvec2 last = lastMet[number];
  PixelRay ray = pixelRay(imagePlane(view, vec2(pixel) + 0.5), 1.0);
  ray.lights = lightRun(lightCell(pixel, view.window));
  bool walking = true;
  while (walking && work < uint(RESOLVE_WORK_LIMIT)) {
    uvec2 next = uvec2(0xffffffffu);
    ivec4 nearest = ivec4(place, 0, 0);
    for (uint i = 0u; i < count; ++i) {
      ivec4 at = placeOf(place, i);
      uvec2 key = layerTexel(keys, at).xy;
      bool behind = walker.layers == 0u || isBefore(last, key);
      if (behind && isBefore(key, next)) {
        next = key;
        nearest = at;
      }
    }
    work += count;
    float depth = uintBitsToFloat(next.x);
    if (marchTo(depth, ray, walker)) {
      if (!walker.ended) {
        PackedSurface surface = layerSurface(nearest);
        walker.radiance += walker.throughput * shadeSurface(unpackSurface(surface), ray, depth, 1.0);
        walker.throughput *= layerPass(surface);
        walker.ended = maxComponent(walker.throughput) < params.march.y;
        last = next;
        ++walker.layers;
      }
      walking = !walker.ended && walker.layers < count;
    }
  }
  if (walking) atomicAdd(counters.unfinished, 1u);
  lastMet[number] = last;
  rays[rayNumber] = stateOf(walker);
}
