// Light that media emit by themselves. FIRE is defined where some do.
#include "shaders/volumes/media.glsl"

#ifdef FIRE
layout(std430, binding = STORAGE_FIRE_RAMPS) readonly buffer FireRamps {
  vec4 fireRamps[];  // rgb
};
#endif

// Radiance per metre at a depth along the ray.
vec3 emission(MediaRay ray, float depth) {
  vec3 sum = vec3(0.0);
#ifdef FIRE
  for (int v = VOLUME_COUNT; v < GRID_COUNT; ++v) {
    if (depth < ray.range[v].x || depth > ray.range[v].y) continue;
    vec3 ramp = volumes[v].ramp.xyz;
    float place = min(sampleGrid(v, ray.start[v] + depth * ray.perDepth[v]) * ramp.x, ramp.z - ramp.y);
    float low = min(floor(place), ramp.z - ramp.y - 1.0);
    int entry = int(ramp.y + low);
    sum += mix(fireRamps[entry].rgb, fireRamps[entry + 1].rgb, place - low);
  }
#endif
  return sum;
}
