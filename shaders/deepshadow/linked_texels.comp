// The texels of a face whose lists stay linked, for comparisons.
#include "shaders/shared/bindings.h"
#include "shaders/shared/deepshadow.h"
#include "shaders/shared/linear_id.glsl"
#include "shaders/shared/view_block.glsl"

layout(std430, binding = STORAGE_LIST_HEADS) readonly buffer Heads {
  uint listHeads[];
};
layout(std430, binding = STORAGE_SHADOW_TEXELS) writeonly buffer Texels {
  ShadowTexel texels[];
};
layout(binding = TEXTURE_OPAQUE_DEPTH) uniform sampler2D opaqueDepth;

void main() {
  uint cell = linearId();
  if (cell >= uint(view.size.x * view.size.y)) return;
  float opaque = texelFetch(opaqueDepth, ivec2(int(cell) % view.size.x, int(cell) / view.size.x), 0).r;
  uint head = listHeads[uint(view.size.z) + cell];
  texels[uint(view.size.z) + cell] = ShadowTexel(head, head != 0u ? 1u : 0u, opaque);
}
