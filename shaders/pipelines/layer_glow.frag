// What a layer's surfaces give by themselves, before any light is added. FINISHED: as radiance, in table storage, too, and
// how deep they are.
#include "shaders/pipelines/layer.glsl"

layout(location = 0) out vec4 light;
#ifdef FINISHED
layout(location = 1) out float depth;
#endif

void main() {
#ifdef FINISHED
  depth = layerDepth(ivec2(gl_FragCoord.xy));
#endif
#if defined(TABLE_STORAGE) && !defined(FINISHED)
  light = vec4(0.0);
#else
  light = vec4(unpackSurface(layerSurface(ivec2(gl_FragCoord.xy))).emissive, 0.0);
#endif
}
