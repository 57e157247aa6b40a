// Light on surfaces.
#include "shaders/deepshadow/lookup.glsl"
#include "shaders/pipelines/ambient.glsl"
#include "shaders/pipelines/brdf.glsl"
#include "shaders/pipelines/pixel_ray.glsl"

vec3 reflectedFrom(uint number, Surface surface, vec3 p, vec3 toViewer) {
  LightData light = lights[number];
  vec3 toLight;
  vec3 irradiance = lightFrom(light, p, toLight);
  float cosine = dot(surface.normal, toLight);
  if (maxComponent(irradiance) <= 0.0 || cosine <= 0.0 || dot(surface.geometricNormal, toLight) <= 0.0) return vec3(0.0);
  if (light.indices.y >= 0) {
    COUNT_LOOKUP(y);
    irradiance *= shadowOnSurface(light.indices.y, light.indices.z, light.position.xyz, p, surface.geometricNormal,
                                  surface.object, params.options.y & 7);
  }
  return brdf(surface, toLight, toViewer) * irradiance * cosine;
}

// Emitted and reflected radiance towards the viewer, lit by every light that reaches it and by so much of the ambient one.
vec3 shadeSurface(Surface surface, PixelRay ray, float depth, float accessibility) {
  vec3 p = ray.origin + depth * ray.perDepth;
  vec3 sum = surface.emissive;
#ifdef AMBIENT
  sum += ambientFrom(surface, params.ambient.rgb, accessibility);
#endif
  bool reached = true;
  uint walked = 0u;
  while (reached && walked < min(lightsOf(ray), LIGHT_WALK_LIMIT)) {
    ListedLight at = lightOf(ray, walked);
    reached = at.front <= depth;
    if (reached && depth <= at.back) sum += reflectedFrom(at.light, surface, p, ray.towardsViewer);
    ++walked;
    work += 16u;
  }
  if (walked == LIGHT_WALK_LIMIT) atomicAdd(counters.boundHit, 1u);
  return sum;
}
