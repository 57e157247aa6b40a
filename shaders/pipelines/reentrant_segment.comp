// What a layer's surfaces let through of the finished light behind them and of the smoke between: the 'background'. TO_CAMERA:
// what reaches the camera. A ray that has done much work goes on in the next dispatch; params.options.x numbers the segments.
#include "shaders/pipelines/camera_ray.glsl"
#include "shaders/pipelines/layer.glsl"
#include "shaders/pipelines/smoke_segment.glsl"
#include "shaders/shared/linear_id.glsl"

layout(std430, binding = STORAGE_RAYS) buffer Rays {
  RayState rays[];
};
layout(binding = TEXTURE_FINISHED_LIGHT) uniform sampler2D finishedLight;
layout(binding = TEXTURE_FINISHED_DEPTH) uniform sampler2D finishedDepth;  // of what that is the light of

// Which pixel's light is seen through a surface: its normal shifts it, but to nothing that is in front of the surface.
ivec2 refracted(ivec2 pixel, float depth, PackedSurface surface) {
  vec3 normal = mat3(view.viewFromWorld) * unpackSurface(surface).normal;
  ivec2 shifted = pixel + ivec2(round(normal.xy * params.march.z));
  bool inside = all(greaterThanEqual(shifted, ivec2(0))) && all(lessThan(shifted, view.size.xy));
  return inside && texelFetch(finishedDepth, shifted, 0).r > depth ? shifted : pixel;
}

void main() {
  uint number = linearId();
  if (number >= uint(params.options.w)) return;
  ivec2 pixel = params.area.xy + placeInRows(number, params.area.z);
  number = uint(pixel.y * view.size.x + pixel.x);
#ifdef TO_CAMERA
  float start = view.depthRange.x;
  vec3 pass = vec3(1.0);
  ivec2 seen = pixel;
#else
  float start = layerDepth(pixel);
  if (start >= view.depthRange.y) return;
  PackedSurface surface = layerSurface(pixel);
  vec3 pass = layerPass(surface);
  ivec2 seen = refracted(pixel, start, surface);
#endif
  uint segment = uint(params.options.x);
  Walker walker = walkerOf(rays[number]);
  if (walker.layers != segment) walker = Walker(vec3(0.0), vec3(1.0), start, segment, false);
  if (walker.ended) return;
  PixelRay ray = pixelRay(imagePlane(view, vec2(pixel) + 0.5), 1.0);
#ifdef SMOKE
  ray.lights = lightRun(lightCell(pixel, view.window));
#endif
  if (!marchTo(min(texelFetch(finishedDepth, seen, 0).r, view.depthRange.y), ray, walker)) {
    atomicAdd(counters.unfinished, 1u);
  } else {
    atomicAdd(counters.groups, 1u);
    walker.radiance = pass * (walker.radiance + walker.throughput * texelFetch(finishedLight, seen, 0).rgb);
    walker.ended = true;
  }
  rays[number] = stateOf(walker);
}
