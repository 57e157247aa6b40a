// Translucent surfaces into the lists of a light's texels, as far as light gets there at all.
#include "shaders/deepshadow/node.glsl"
#include "shaders/scene/material.glsl"

layout(binding = TEXTURE_OPAQUE_DEPTH) uniform sampler2D opaqueDepth;

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  float depth = fragmentDepth();
  vec4 base = baseColour();
  vec3 pass = passThrough(base, transmission());
  if (base.a > 0.0 && depth < texelFetch(opaqueDepth, texel, 0).r) {
    vec3 tau = min(-log(max(pass, 1e-30)), SHADOW_OPAQUE_TAU);
    insertShadowNode(uint(view.size.z + texel.y * view.size.x + texel.x), depth, 0.0, tau, fragmentId(), 0u);
  }
}
