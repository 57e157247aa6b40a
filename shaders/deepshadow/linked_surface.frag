// Surfaces into linked lists, for comparisons. Opaque ones, for which OPAQUE is defined, are nodes as well, behind which none
// is kept (Lindbeck 2015, 2.2.1): what hides them was not drawn before.
#include "shaders/shared/deepshadow.h"
#define LIST_PAYLOAD ShadowNode
#define LIST_ENDING_ID SHADOW_OPAQUE_ID
#include "shaders/lists/insert.glsl"
#include "shaders/deepshadow/way_through.glsl"

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  vec4 base = baseColour();
#ifdef OPAQUE
  vec3 tau = vec3(SHADOW_OPAQUE_TAU);
  uint id = SHADOW_OPAQUE_ID;
#else
  vec3 tau = surfaceTau(base);
  uint id = fragmentId();
#endif
  if (base.a > 0.0) {
    ShadowNode node = ShadowNode(packHalf2x16(tau.rg), packHalf2x16(vec2(tau.b, 0.0)));
    listStore(uint(view.size.z + texel.y * view.size.x + texel.x), fragmentDepth(), id, node);
  }
}
