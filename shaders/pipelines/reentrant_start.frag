// The finished light buffer where a layer was drawn: no more than what its surfaces emit, and their depth.
#include "shaders/pipelines/layer.glsl"

layout(location = 0) out vec4 light;
layout(location = 1) out float depth;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  light = vec4(unpackSurface(layerSurface(pixel)).emissive, 0.0);
  depth = layerDepth(pixel);
}
