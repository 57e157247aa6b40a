// Composes an image in which pixels of translucent surfaces stand between those of what is behind them (Aladagli 2015,
// section 3.3): each pixel finds what it lacks beside it, and its ray is taken through both and the smoke before them.
// INTERLACE says which pixels are which. REFRACT_BY_MASK takes what is seen through a surface from anywhere that a
// translucent surface covers, as a renderer without depths has to; else from anywhere behind it.
#include "shaders/pipelines/camera_ray.glsl"
#include "shaders/pipelines/interlace.glsl"
#include "shaders/shared/bindings.h"
#include "shaders/shared/math.glsl"
#ifdef FORWARD
#include "shaders/pipelines/forward_image.glsl"
#else
#include "shaders/pipelines/layer.glsl"
#endif
#include "shaders/pipelines/smoke_segment.glsl"
#include "shaders/shared/linear_id.glsl"

layout(std430, binding = STORAGE_RAYS) buffer Rays {
  RayState rays[];
};

struct Translucent {
  bool seen;
  float depth;
  vec3 radiance;
  vec3 pass;
  vec3 normal;
};

struct Background {
  float depth;
  vec3 radiance;
};

bool isInImage(ivec2 pixel) {
  return all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, view.size.xy));
}

// Pixels beside one of the other kind.
#if INTERLACE == INTERLACE_CHECKERBOARD
const int BESIDE = 4;
const ivec2 beside[BESIDE] = ivec2[](ivec2(0, 1), ivec2(0, -1), ivec2(1, 0), ivec2(-1, 0));
#else
const int BESIDE = 2;
const ivec2 beside[BESIDE] = ivec2[](ivec2(0, 1), ivec2(0, -1));
#endif

bool showsTranslucent(ivec2 pixel) {
  return maybeTranslucent(pixel) && isTranslucentAt(pixel) && layerDepth(pixel) < NOTHING_SEEN;
}

// What stands in a pixel before its background: its own, or the mean of what is beside it, where a surface that ends
// between the two is half there.
Translucent translucentAt(ivec2 pixel) {
  Translucent result = Translucent(false, NOTHING_SEEN, vec3(0.0), vec3(1.0), vec3(0.0));
  if (maybeTranslucent(pixel)) {
    if (!showsTranslucent(pixel)) return result;
    return Translucent(true, layerDepth(pixel), layerRadiance(pixel), passAt(pixel), normalAt(pixel));
  }
  float own = layerDepth(pixel);
  Translucent sum = Translucent(false, 0.0, vec3(0.0), vec3(0.0), vec3(0.0));
  float asked = 0.0;
  float found = 0.0;
  for (int i = 0; i < BESIDE; ++i) {
    ivec2 other = pixel + beside[i];
    if (!isInImage(other)) continue;
    asked += 1.0;
    if (showsTranslucent(other) && layerDepth(other) < own) {
      found += 1.0;
      sum.depth += layerDepth(other);
      sum.radiance += layerRadiance(other);
      sum.pass += passAt(other);
      sum.normal += normalAt(other);
    }
  }
  if (found == 0.0) return result;
  vec3 pass = (sum.pass + (asked - found)) / asked;
  return Translucent(true, sum.depth / found, sum.radiance / asked, pass, sum.normal / found);
}

// What is opaque at a pixel: its own, or the mean of what is beside it and behind `front`, the farthest where nothing is.
Background backgroundAt(ivec2 pixel, float front) {
  if (!showsTranslucent(pixel)) return Background(layerDepth(pixel), layerRadiance(pixel));
  Background farthest = Background(-1.0, vec3(0.0));
  vec3 sum = vec3(0.0);
  float found = 0.0;
  for (int i = 0; i < BESIDE; ++i) {
    ivec2 other = pixel + beside[i];
    if (!isInImage(other)) continue;
    float depth = layerDepth(other);
    vec3 radiance = layerRadiance(other);
    if (depth > farthest.depth) farthest = Background(depth, radiance);
    if (depth > front) {
      sum += radiance;
      found += 1.0;
    }
  }
  if (found > 0.0) farthest.radiance = sum / found;
  if (farthest.depth < 0.0) farthest.depth = NOTHING_SEEN;  // an image of one line
  return farthest;
}

// The background as it is seen through a surface.
Background refracted(ivec2 pixel, Translucent surface) {
  Background straight = backgroundAt(pixel, surface.depth);
  if (params.march.z == 0.0) return straight;
  vec2 shift = (mat3(view.viewFromWorld) * surface.normal).xy * params.march.z;
  ivec2 place = pixel + ivec2(round(shift));
  if (!isInImage(place)) return straight;
  Background bent = backgroundAt(place, surface.depth);
#ifdef REFRACT_BY_MASK
  return translucentAt(place).seen ? bent : straight;
#else
  return bent.depth > surface.depth ? bent : straight;
#endif
}

void main() {
  uint number = linearId();
  if (number >= uint(params.options.w)) return;
  Walker walker = walkerOf(rays[number]);
  if (walker.ended) return;
  ivec2 pixel = placeInRows(number, view.size.x);
  Translucent surface = translucentAt(pixel);
  Background background = surface.seen ? refracted(pixel, surface) : backgroundAt(pixel, 0.0);
  PixelRay ray = pixelRay(imagePlane(view, vec2(pixel) + 0.5), 1.0);
#ifdef SMOKE
  ray.lights = lightRun(lightCell(pixel, view.window));
#endif
  bool done = true;
  if (surface.seen && walker.layers == 0u) {
    done = marchTo(surface.depth, ray, walker);
    if (done && !walker.ended) {
      walker.radiance += walker.throughput * surface.radiance;
      walker.throughput *= surface.pass;
      walker.layers = 1u;
    }
  }
  if (done && !walker.ended) {
    done = marchTo(min(background.depth, view.depthRange.y), ray, walker);
    if (done && !walker.ended) walker.radiance += walker.throughput * background.radiance;
  }
  if (!done) atomicAdd(counters.unfinished, 1u);
  walker.ended = done;
  rays[number] = stateOf(walker);
}
