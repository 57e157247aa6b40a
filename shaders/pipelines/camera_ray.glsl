// Rays of the camera's pixels and of the samples in them.
#include "shaders/shared/view.h"

// The G-buffer is multisampled where there is more than one sample; texelFetch(sampler, pixel, sample) reads either.
#if SAMPLES > 1
#define pixelSampler sampler2DMS
#define pixelUsampler usampler2DMS
#else
#define pixelSampler sampler2D
#define pixelUsampler usampler2D
#endif

bool hasList(ViewParams camera, ivec2 pixel) {
  ivec2 place = pixel - camera.window.xy;
  return all(greaterThanEqual(place, ivec2(0))) && all(lessThan(place, camera.window.zw));
}

// The number of the list of a pixel of the image.
uint listOfPixel(ViewParams camera, ivec2 pixel) {
  ivec2 place = pixel - camera.window.xy;
  return uint(place.y * camera.window.z + place.x);
}

// The point at depth 1 (perspective) or the offset (orthographic) of an image position in pixels, view space.
vec2 imagePlane(ViewParams camera, vec2 position) {
  return (position / vec2(camera.size.xy) * 2.0 - 1.0) * camera.halfExtent.xy;
}

// Depth at which the ray through plane position `to` meets the plane that has normal `normal` (view space) and holds the
// point of depth `depth` on the ray through `from`; `depth` itself where that plane is seen edge-on.
float depthOnPlane(ViewParams camera, vec3 normal, vec2 from, float depth, vec2 to) {
  bool orthographic = camera.halfExtent.z != 0.0;
  vec3 p = orthographic ? vec3(from, -depth) : depth * vec3(from, -1.0);
  float met = orthographic ? (dot(normal.xy, to) - dot(normal, p)) / normal.z : dot(normal, p) / dot(normal, vec3(to, -1.0));
  float pixel = 2.0 * camera.halfExtent.y / float(camera.size.y) * (orthographic ? 1.0 : depth);
  return abs(met - depth) < 64.0 * pixel ? met : depth;
}
