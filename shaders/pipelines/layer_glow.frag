// What a layer's surfaces give before any light is added. TABLE_STORAGE: see layer.glsl.
#include "shaders/pipelines/layer.glsl"
#include "shaders/pipelines/layer_ambient.glsl"

layout(location = 0) out vec4 light;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  PackedSurface stored = layerSurface(pixel);
  Surface surface = unpackSurface(stored);
  float depth = layerDepth(pixel);
  light = vec4(0.0);
  if (depth >= NOTHING_SEEN) return;
#ifndef TABLE_STORAGE
  light.rgb = glow(surface, pixel, depth, isTranslucent(stored));
#elif defined(AMBIENT)
  // The colours that this meets are counted later.
  vec3 ambient = params.ambient.rgb * accessibilityOf(surface, pixel, depth, isTranslucent(stored));
  light = vec4(ambient * notMirrored(surface, surface.f0), maxComponent(ambient * surface.f0));
#endif
}
