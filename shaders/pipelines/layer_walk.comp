// Takes the pixels' rays on to a layer's surfaces: through the smoke before them, then past them. LAST is defined for the
// layer that ends all rays, also where it has no surface; a ray that has done much work goes on in the next dispatch.
#define SAMPLES 1
#include "shaders/pipelines/camera_ray.glsl"
#include "shaders/pipelines/layer.glsl"
#include "shaders/pipelines/smoke_segment.glsl"
#include "shaders/shared/linear_id.glsl"

layout(std430, binding = STORAGE_RAYS) buffer Rays {
  RayState rays[];
};

void main() {
  uint number = linearId();
  if (number >= uint(params.options.w)) return;
  ivec2 pixel = ivec2(int(number) % view.size.x, int(number) / view.size.x);
  float at = layerDepth(pixel);
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
      PackedSurface surface = layerSurface(pixel);
      walker.radiance += walker.throughput * layerRadiance(pixel);
      walker.throughput *= layerPass(surface);
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
