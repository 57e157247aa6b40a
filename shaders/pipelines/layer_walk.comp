// Takes the pixels' rays on to a layer's surfaces: through the smoke before them, then past them. LAST is defined for the
// layer that ends all rays, also where it has no surface; a ray that has done much work goes on in the next dispatch.
// BENT is defined where the first surface bends the way to the last layer.
#include "shaders/pipelines/camera_ray.glsl"
#include "shaders/pipelines/layer.glsl"
#include "shaders/pipelines/smoke_segment.glsl"
#include "shaders/shared/linear_id.glsl"

layout(std430, binding = STORAGE_RAYS) buffer Rays {
  RayState rays[];
};

#ifdef BENT
// By how many pixels, as two halves, and behind which depth; 0: not yet.
layout(std430, binding = STORAGE_BENDS) buffer Bends {
  uvec2 bends[];
};

void bend(uint number, float depth, vec3 normal) {
  if (bends[number].y != 0u) return;
  vec2 shift = (mat3(view.viewFromWorld) * normal).xy * params.march.z;
  bends[number] = uvec2(packHalf2x16(shift), floatBitsToUint(depth));
}

// Where the layer is looked at through a pixel's surfaces: straight on where something before them would be seen.
ivec2 bent(uint number, ivec2 pixel) {
  ivec2 place = pixel + ivec2(round(unpackHalf2x16(bends[number].x)));
  bool inside = all(greaterThanEqual(place, ivec2(0))) && all(lessThan(place, view.size.xy));
  return inside && layerDepth(place) > uintBitsToFloat(bends[number].y) ? place : pixel;
}
#endif

void main() {
  uint number = linearId();
  if (number >= uint(params.options.w)) return;
  ivec2 pixel = placeInRows(number, view.size.x);
  ivec2 place = pixel;
#if defined(BENT) && defined(LAST)
  place = bent(number, pixel);
#endif
  float at = layerDepth(place);
  bool seen = at < view.depthRange.y;
  Walker walker = walkerOf(rays[number]);
#ifndef LAST
  if (!seen) return;
#endif
  if (walker.ended || walker.layers >= uint(params.options.x)) return;
  PixelRay ray = pixelRay(imagePlane(view, vec2(pixel) + 0.5), 1.0);
#ifdef SMOKE
  ray.lights = lightRun(lightCell(pixel, view.window));
#endif
  if (!marchTo(min(at, view.depthRange.y), ray, walker)) {
    atomicAdd(counters.unfinished, 1u);
  } else {
    if (seen && !walker.ended) {
      atomicAdd(counters.groups, 1u);
      walker.radiance += walker.throughput * layerRadiance(place);
      walker.throughput *= layerPass(layerSurface(place));
#if defined(BENT) && !defined(LAST)
      bend(number, at, normalAt(place));
#endif
    }
    walker.layers = uint(params.options.x);
#ifdef LAST
    walker.ended = true;
#else
    walker.ended = walker.ended || maxComponent(walker.throughput) < params.march.y;
#endif
  }
  rays[number] = stateOf(walker);
}
