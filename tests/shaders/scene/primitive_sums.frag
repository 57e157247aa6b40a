// To be added up: how many triangles, and which.
#ifdef COVERING
#include "shaders/scene/covered.glsl"
#endif
layout(location = 0) out vec4 sums;

void main() {
#ifdef COVERING
  if (!isCovered(ivec2(gl_FragCoord.xy))) discard;
#endif
  float number = float(gl_PrimitiveID + 1);
  sums = vec4(1.0, number, number * number, 0.0);
}
