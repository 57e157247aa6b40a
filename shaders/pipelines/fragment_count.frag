// One for each translucent fragment before the opaque surfaces, to be added up.
#include "shaders/scene/material.glsl"

layout(binding = TEXTURE_OPAQUE_DEPTH) uniform sampler2D opaqueDepth;
layout(location = 0) out float one;

void main() {
  vec4 base = baseColour();
  ivec2 pixel = ivec2(gl_FragCoord.xy);
#ifdef COVERING
  if (!isCovered(pixel)) discard;
#endif
  if (base.a == 0.0 || fragmentDepth() >= texelFetch(opaqueDepth, pixel, 0).r) discard;
  one = 1.0;
}
