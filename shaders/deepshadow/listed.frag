// Translucent surfaces, and opaque ones that do not shadow themselves, into the lists of a light's texels, as far as
// light gets there at all.
#define LIST_PAYLOAD ShadowNode
#include "shaders/shared/deepshadow.h"
#include "shaders/lists/insert.glsl"
#include "shaders/deepshadow/way_through.glsl"

layout(binding = TEXTURE_OPAQUE_DEPTH) uniform sampler2D opaqueDepth;

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  float depth = fragmentDepth();
  vec4 base = baseColour();
  vec3 tau = surfaceTau(base);
  if (base.a > 0.0 && depth < texelFetch(opaqueDepth, texel, 0).r) {
    uint object = uint(drawIndices().z);
    ShadowNode node = ShadowNode(packHalf2x16(tau.rg), packHalf2x16(vec2(tau.b, 0.0)) | object << 16);
    listStore(uint(texel.y * view.size.x + texel.x), depth, fragmentId(), node);
  }
}
