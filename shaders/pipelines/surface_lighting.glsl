// Light on surfaces.
#include "shaders/deepshadow/shadows.glsl"
#include "shaders/pipelines/ambient.glsl"
#include "shaders/pipelines/brdf.glsl"
#include "shaders/pipelines/pixel_ray.glsl"

// Irradiance from a light, shadows counted.
vec3 receivedFrom(uint number, Surface surface, vec3 p, out vec3 toLight) {
  LightData light = lightAt(number);
  vec3 irradiance = lightFrom(light, p, toLight);
  float cosine = dot(surface.normal, toLight);
  if (maxComponent(irradiance) <= 0.0 || cosine <= 0.0 || dot(surface.geometricNormal, toLight) <= 0.0) return vec3(0.0);
  if (light.indices.y >= 0) {
    COUNT_LOOKUP(y);
    irradiance *= shadowOnSurface(light.indices.y, light.indices.z, light.position.xyz, p, surface.geometricNormal,
                                  surface.object, params.options.y & 7);
  }
  return irradiance * cosine;
}

vec3 reflectedFrom(uint number, Surface surface, vec3 p, vec3 toViewer) {
  vec3 toLight;
  vec3 received = receivedFrom(number, surface, p, toLight);
  return maxComponent(received) > 0.0 ? brdf(surface, toLight, toViewer) * received : vec3(0.0);
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
