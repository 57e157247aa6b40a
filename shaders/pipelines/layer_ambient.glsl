// What a layer's surface gives by itself, and what it returns of the light from all around: see ambient.glsl. No occlusion is
// known for translucent surfaces.
#include "shaders/pipelines/accessibility.glsl"
#include "shaders/pipelines/ambient.glsl"
#include "shaders/shared/resolve_block.glsl"
#include "shaders/shared/view_block.glsl"

float accessibilityOf(Surface surface, ivec2 pixel, float depth, bool translucent) {
  return translucent ? 1.0 : accessibilityAt(view, vec2(pixel) + 0.5, depth, surface.geometricNormal, params.ambient.w);
}

vec3 glow(Surface surface, ivec2 pixel, float depth, bool translucent) {
  vec3 sum = surface.emissive;
#ifdef AMBIENT
  sum += ambientFrom(surface, params.ambient.rgb, accessibilityOf(surface, pixel, depth, translucent));
#endif
  return sum;
}
