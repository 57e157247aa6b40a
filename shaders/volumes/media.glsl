// Density, extinction and phase of the media in the scene. VOLUME_COUNT is how many there are, at least 1.
#include "shaders/shared/bindings.h"
#include "shaders/shared/math.glsl"
#include "shaders/shared/volumes.h"
#include "shaders/volumes/extinction.glsl"
#include "shaders/volumes/grid.glsl"

layout(std430, binding = STORAGE_VOLUMES) readonly buffer Volumes {
  VolumeData volumes[];
};

// The grids that a ray marches through: those of the media and, where FIRE says that something burns, of the fires.
#ifdef FIRE
#define MARCHED GRID_COUNT
#else
#define MARCHED VOLUME_COUNT
#endif

// A ray through media and fires: points are start + depth * perDepth, in coordinates of each one's grid.
struct MediaRay {
  vec3 start[MARCHED];
  vec3 perDepth[MARCHED];
  vec2 range[MARCHED];  // of depth, inside the medium's box; empty when x >= y
  float stride[MARCHED];  // of a march through the medium, in depth
  vec2 rangeOfAll;
};

MediaRay mediaRay(vec3 origin, vec3 perDepth, vec2 depthRange, float stepVoxels) {
  MediaRay ray;
  ray.rangeOfAll = vec2(3e38, -3e38);
  for (int v = 0; v < MARCHED; ++v) {
    vec3 start = (grids[v].gridFromWorld * vec4(origin, 1.0)).xyz;
    vec3 rate = (grids[v].gridFromWorld * vec4(perDepth, 0.0)).xyz;
    vec3 safeRate = mix(rate, vec3(1e-20), lessThan(abs(rate), vec3(1e-20)));
    vec3 toMin = (grids[v].boxMin.xyz - start) / safeRate;
    vec3 toMax = (grids[v].boxMax.xyz - start) / safeRate;
    vec3 entry = min(toMin, toMax);
    vec3 leave = max(toMin, toMax);
    vec2 range = vec2(max(max(entry.x, entry.y), max(entry.z, depthRange.x)), min(min(leave.x, leave.y), min(leave.z, depthRange.y)));
    ray.start[v] = start;
    ray.perDepth[v] = rate;
    ray.range[v] = range;
    ray.stride[v] = stepVoxels * volumes[v].phase.y / length(perDepth);
    if (range.x < range.y) ray.rangeOfAll = vec2(min(ray.rangeOfAll.x, range.x), max(ray.rangeOfAll.y, range.y));
  }
  return ray;
}

// Where the step that begins at `depth` ends: it is as long as the finest medium there wants it, and crosses neither
// the border of a medium nor `limit`. Steps stand at multiples of their length from where the ray enters the media, so
// that a surface which cuts one does not move the others.
float stepEnd(MediaRay ray, float depth, float limit) {
  float stride = 3e38;
  for (int v = 0; v < MARCHED; ++v) {
    if (ray.range[v].x < ray.range[v].y && depth < ray.range[v].y) {
      bool inside = depth >= ray.range[v].x;
      limit = min(limit, inside ? ray.range[v].y : ray.range[v].x);
      if (inside) stride = min(stride, ray.stride[v]);
    }
  }
  float entry = ray.rangeOfAll.x;
  float to = entry + (floor((depth - entry) / stride + 1e-3) + 1.0) * stride;
  if (to <= depth) to = depth + stride;
  return to > depth ? min(to, limit) : limit;  // a stride below the rounding of the depth
}

#ifdef COUNT_LOOKUPS
uint jumped = 0u;  // steps of this invocation that emptyEnd spared
#endif

float filledUntil = -3e38;  // depth along the ray of this invocation before which there is no use in asking again

// Of the step that begins at `depth` and ends at `to`, nothing was found in its middle: where the last step ends of which
// the bricks say the same. Ends are those of stepEnd.
float emptyEnd(MediaRay ray, float depth, float to, float limit) {
  float middle = 0.5 * (depth + to);
  if (middle < filledUntil) return to;
  float until = 3e38;
  float stride = 3e38;
  for (int v = 0; v < MARCHED; ++v) {
    if (ray.range[v].x < ray.range[v].y && depth < ray.range[v].y) {
      bool inside = depth >= ray.range[v].x;
      limit = min(limit, inside ? ray.range[v].y : ray.range[v].x);
      if (inside) {
        stride = min(stride, ray.stride[v]);
        vec2 emptyFilled = emptyFilledUntil(v, ray.start[v], ray.perDepth[v], middle);
        until = min(until, emptyFilled.x);
        filledUntil = max(filledUntil, emptyFilled.y);
      }
    }
  }
  float entry = ray.rangeOfAll.x;
  float end = max(to, min(entry + floor((until - entry) / stride + 0.5) * stride, limit));
#ifdef COUNT_LOOKUPS
  jumped += uint(ceil((end - to) / stride - 0.5));
#endif
  return end;
}

// A bound of the steps of a march through all of the ray.
float stepsAtMost(MediaRay ray) {
  float stride = 3e38;
  for (int v = 0; v < MARCHED; ++v) stride = min(stride, ray.stride[v]);
  return (ray.rangeOfAll.y - ray.rangeOfAll.x) / stride + float(2 * MARCHED);
}

// Extinction of medium v at a depth along the ray in the channel of which it takes most, 1/m.
float extinctionOf(int v, MediaRay ray, float depth) {
  bool inside = depth >= ray.range[v].x && depth <= ray.range[v].y;
  float density = sampleGrid(v, ray.start[v] + depth * ray.perDepth[v]);
  return inside ? density * volumes[v].extinction.w : 0.0;
}

// The same in each channel.
Extinction inChannels(int v, float densest) {
#ifdef COLOURED_SMOKE
  return densest * volumes[v].extinction.rgb;
#else
  return densest;
#endif
}

Extinction extinction(MediaRay ray, float depth) {
  Extinction sum = Extinction(0.0);
  for (int v = 0; v < VOLUME_COUNT; ++v) sum += inChannels(v, extinctionOf(v, ray, depth));
  return sum;
}

// Over which length what lies in a step of an optical depth is seen: the integral of exp(-sigma_t s), its series where the
// difference would cancel.
float seenLength(float tau, float stepLength) {
  return stepLength * (tau > 1e-3 ? (1.0 - exp(-tau)) / tau : 1.0 - 0.5 * tau);
}

vec3 seenLength(vec3 tau, float stepLength) {
  return vec3(seenLength(tau.r, stepLength), seenLength(tau.g, stepLength), seenLength(tau.b, stepLength));
}

// Henyey-Greenstein, 1/sr; `cosine` between the directions of travel before and after.
float phaseHenyeyGreenstein(float cosine, float g) {
  float base = 1.0 + g * g - 2.0 * g * cosine;
  return (1.0 - g * g) / (4.0 * PI * base * sqrt(base));
}
