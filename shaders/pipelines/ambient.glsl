// Light that arrives from all around: what a surface returns of it, and how much of it gets there. Where AMBIENT is not
// defined there is none, where SSAO is not, nothing is in its way.
#include "shaders/pipelines/brdf.glsl"

// `ambient`: radiance from all directions; `accessibility`: the part of it that gets to the surface. As for lights, what
// is reflected at once is not there to be scattered, so that a white surface returns as much as arrives.
vec3 ambientFrom(Surface surface, vec3 ambient, float accessibility) {
  return accessibility * ambient * (surface.diffuse * notMirrored(surface, surface.f0) + surface.f0);
}
