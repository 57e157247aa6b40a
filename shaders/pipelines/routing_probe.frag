// Fragments that are to arrive in one sample each.
#ifdef COVERING
#include "shaders/scene/covered.glsl"
#endif
layout(location = 0) out uint arrived;

void main() {
#ifdef COVERING
  if (!isCovered(ivec2(0))) discard;
#endif
  arrived = uint(gl_PrimitiveID + 1);
}
