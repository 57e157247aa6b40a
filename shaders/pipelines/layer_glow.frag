// What a layer's surfaces give before any light is added: what they emit, and return of the ambient light. TABLE_STORAGE: see
// layer.glsl.
#define SAMPLES 1
#include "shaders/pipelines/accessibility.glsl"
#include "shaders/pipelines/ambient.glsl"
#include "shaders/pipelines/layer.glsl"
#include "shaders/pipelines/pass_block.glsl"
#include "shaders/shared/view_block.glsl"

layout(location = 0) out vec4 light;

// Of the ambient light at a pixel, as much as gets to its surface.
vec3 arrivingAmbient(ivec2 pixel, bool translucent, vec3 normal) {
#ifdef AMBIENT
  float depth = layerDepth(pixel);
  if (depth >= NOTHING_SEEN) return vec3(0.0);
  if (translucent) return params.ambient.rgb;
  return params.ambient.rgb * accessibilityAt(view, vec2(pixel) + 0.5, depth, normal, params.ambient.w);
#else
  return vec3(0.0);
#endif
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  PackedSurface stored = layerSurface(pixel);
  Surface surface = unpackSurface(stored);
  vec3 arriving = arrivingAmbient(pixel, isTranslucent(stored), surface.geometricNormal);
#ifdef TABLE_STORAGE
  light = vec4(arriving * (1.0 - maxComponent(surface.f0)), maxComponent(arriving * surface.f0));
#else
  light = vec4(surface.emissive + ambientFrom(surface, arriving, 1.0), 0.0);
#endif
}
