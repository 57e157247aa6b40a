// Light on surfaces.
#include "shaders/deepshadow/shadows.glsl"
#include "shaders/pipelines/ambient.glsl"
#include "shaders/pipelines/brdf.glsl"
#include "shaders/pipelines/pixel_ray.glsl"

// Irradiance from a light, shadows aside.
vec3 unshadowedFrom(LightData light, Surface surface, vec3 p, out vec3 toLight) {
  vec3 irradiance = lightFrom(light, p, toLight);
  float cosine = dot(surface.normal, toLight);
  return cosine > 0.0 && dot(surface.geometricNormal, toLight) > 0.0 ? irradiance * cosine : vec3(0.0);
}

// What of a light gets to a surface.
vec3 shadowOf(LightData light, Surface surface, vec3 p) {
  if (light.indices.y < 0) return vec3(1.0);
  COUNT_LOOKUP(y);
  return shadowOnSurface(light.indices.y, light.indices.z, light.position.xyz, p, surface.geometricNormal, surface.object,
                         params.options.y & 7);
}

// Irradiance from a light, shadows counted.
vec3 receivedFrom(uint number, Surface surface, vec3 p, out vec3 toLight) {
  LightData light = lightAt(number);
  vec3 irradiance = unshadowedFrom(light, surface, p, toLight);
  return maxComponent(irradiance) > 0.0 ? irradiance * shadowOf(light, surface, p) : vec3(0.0);
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
  uint listed = min(lightsOf(ray), LIGHT_WALK_LIMIT);
  bool reached = true;
  uint walked = 0u;
  while (reached && walked < listed) {
    // The next light that gives it any: some drivers run what one of several surfaces needs for all of them.
    uint number = 0u;
    bool lit = false;
    while (reached && walked < listed && !lit) {
      ListedLight at = lightOf(ray, walked);
      number = at.light;
      reached = at.front <= depth;
      vec3 toLight;
      lit = reached && depth <= at.back && maxComponent(unshadowedFrom(lightAt(number), surface, p, toLight)) > 0.0;
      ++walked;
      work += 4u;
    }
    if (lit) sum += reflectedFrom(number, surface, p, ray.towardsViewer);
    work += 12u;
  }
  uint side = uint(params.options.y & 7);
  tellOfManyLights(walked, 12u + 2u * side * side);
  return sum;
}
