// What a light gives to a point, shadows aside.
#include "shaders/shared/bindings.h"
#include "shaders/shared/lights.h"

layout(binding = TEXTURE_LIGHTS) uniform usamplerBuffer lightRows;  // of LightData, gl::Records

uint lightCount() {
  return uint(textureSize(lightRows)) / 5u;
}

LightData lightAt(uint number) {
  int row = 5 * int(number);
  return LightData(uintBitsToFloat(texelFetch(lightRows, row)), uintBitsToFloat(texelFetch(lightRows, row + 1)),
                   uintBitsToFloat(texelFetch(lightRows, row + 2)), uintBitsToFloat(texelFetch(lightRows, row + 3)),
                   ivec4(texelFetch(lightRows, row + 4)));
}

// Irradiance on a surface that faces the light, W/m^2; `toLight` is a unit vector. KHR_lights_punctual.
vec3 lightFrom(LightData light, vec3 pWorld, out vec3 toLight) {
  toLight = -light.direction.xyz;
  if (light.indices.x == LIGHT_DIRECTIONAL) return light.intensity.rgb;
  vec3 away = light.position.xyz - pWorld;
  float d2 = max(dot(away, away), 1e-12);
  if (d2 > light.position.w * light.position.w) return vec3(0.0);
  toLight = away * inversesqrt(d2);
  float angular = clamp(dot(-toLight, light.direction.xyz) * light.cone.x + light.cone.y, 0.0, 1.0);
  float window = clamp(1.0 - d2 * d2 * light.intensity.w, 0.0, 1.0);
  return light.intensity.rgb * (angular * angular * window / d2);
}
