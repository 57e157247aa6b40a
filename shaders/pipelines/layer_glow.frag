// What a layer's surfaces give by themselves, before any light is added.
#include "shaders/pipelines/layer.glsl"

layout(location = 0) out vec4 light;

void main() {
#ifdef TABLE_STORAGE
  light = vec4(0.0);
#else
  light = vec4(unpackSurface(layerSurface(ivec2(gl_FragCoord.xy))).emissive, 0.0);
#endif
}
