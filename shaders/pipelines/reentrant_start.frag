// The finished light buffer where a layer was drawn: what its surfaces give before any light is added, and their depth.
#include "shaders/pipelines/layer.glsl"
#include "shaders/pipelines/layer_ambient.glsl"

layout(location = 0) out vec4 light;
layout(location = 1) out float depth;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  PackedSurface stored = layerSurface(pixel);
  depth = layerDepth(pixel);
  light = vec4(glow(unpackSurface(stored), pixel, depth, isTranslucent(stored)), 0.0);
}
