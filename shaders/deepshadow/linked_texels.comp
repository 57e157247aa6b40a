// The texels of a face whose lists stay linked, for comparisons.
#include "shaders/shared/bindings.h"
#include "shaders/shared/deepshadow.h"
#include "shaders/shared/linear_id.glsl"
#include "shaders/shared/lists.h"
#include "shaders/shared/view_block.glsl"

layout(std430, binding = STORAGE_LIST_HEADS) readonly buffer Heads {
  uint listHeads[];
};
layout(std430, binding = STORAGE_SHADOW_TEXELS) writeonly buffer Texels {
  ShadowTexel texels[];
};
layout(binding = TEXTURE_SHADOW_KNOTS) uniform usamplerBuffer shadowLinks;  // ListLink

void main() {
  uint cell = linearId();
  if (cell >= uint(view.size.x * view.size.y)) return;
  uint head = listHeads[uint(view.size.z) + cell];
  float opaque = NOTHING_OPAQUE;
  uint node = head;
  for (uint walked = 0u; node != 0u && walked < LIST_WALK_LIMIT; ++walked) {
    uvec3 link = texelFetch(shadowLinks, int(node)).xyz;
    if (link.y == SHADOW_OPAQUE_ID) opaque = uintBitsToFloat(link.x);
    node = link.z;
  }
  texels[uint(view.size.z) + cell] = ShadowTexel(head, head != 0u ? 1u : 0u, opaque);
}
