// What a light gives to a point, shadows aside.
#include "shaders/shared/bindings.h"
#include "shaders/shared/lights.h"

layout(std430, binding = STORAGE_LIGHTS) readonly buffer Lights {
  LightData lights[];
};

// Irradiance on a surface that faces the light, W/m^2; `toLight` is a unit vector. KHR_lights_punctual.
vec3 lightAt(uint number, vec3 pWorld, out vec3 toLight) {
  vec4 intensity = lights[number].intensity;
  vec3 direction = lights[number].direction.xyz;
  toLight = -direction;
  if (lights[number].indices.x == LIGHT_DIRECTIONAL) return intensity.rgb;
  vec4 position = lights[number].position;
  vec3 away = position.xyz - pWorld;
  float d2 = max(dot(away, away), 1e-12);
  if (d2 > position.w * position.w) return vec3(0.0);
  toLight = away * inversesqrt(d2);
  vec2 cone = lights[number].cone.xy;
  float angular = clamp(dot(-toLight, direction) * cone.x + cone.y, 0.0, 1.0);
  float window = clamp(1.0 - d2 * d2 * intensity.w, 0.0, 1.0);
  return intensity.rgb * (angular * angular * window / d2);
}
