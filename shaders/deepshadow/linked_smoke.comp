// The smoke of a face into linked lists, for comparisons: for each texel some nodes, each the optical depth of an equal
// stretch of the ray through all media, up to the opaque surface in the list. With one node this is the smoke of Lindbeck
// 2015, 2.2.5.
#include "shaders/shared/deepshadow.h"
#define LIST_PAYLOAD ShadowNode
#define LIST_ENDING_ID SHADOW_OPAQUE_ID
#include "shaders/lists/insert.glsl"
#include "shaders/shared/linear_id.glsl"
#include "shaders/shared/view_block.glsl"
#include "shaders/volumes/media.glsl"

layout(std140, binding = UNIFORM_PASS) uniform Pass {
  ShadowPassParams params;
};

// Of the surface that ends a cell's list.
float opaqueDepthOf(uint cell) {
  float opaque = NOTHING_OPAQUE;
#if LIST_PASS == LIST_PASS_SPINLOCK
  uint node = listHeads[cell];
  for (uint walked = 0u; node != 0u && walked < LIST_WALK_LIMIT; ++walked) {
    if (linkKey(node).y == SHADOW_OPAQUE_ID) opaque = uintBitsToFloat(linkKey(node).x);
    node = linkNext(node);
  }
#endif
  return opaque;
}

void main() {
  uint cell = linearId();
  if (cell >= uint(view.size.x * view.size.y)) return;
  ivec2 texel = placeInRows(cell, view.size.x);
  float opaque = opaqueDepthOf(uint(view.size.z) + cell);
  vec2 plane = ((vec2(texel) + 0.5) / vec2(view.size.xy) * 2.0 - 1.0) * view.halfExtent.xy;
  bool orthographic = view.halfExtent.z != 0.0;
  vec3 origin = (view.worldFromView * vec4(orthographic ? vec3(plane, 0.0) : vec3(0.0), 1.0)).xyz;
  vec3 perDepth = mat3(view.worldFromView) * (orthographic ? vec3(0.0, 0.0, -1.0) : vec3(plane, -1.0));
  MediaRay media = mediaRay(origin, perDepth, vec2(0.0, opaque), params.march.x);
  vec2 range = media.rangeOfAll;
  float depth = range.x;
  for (int i = 0; i < params.units.x && depth < range.y; ++i) {
    float from = depth;
    float to = mix(range.x, range.y, float(i + 1) / float(params.units.x));
    float tau = 0.0;
    while (depth < to) {
      float next = stepEnd(media, depth, to);
      tau += maxComponent(vec3(extinction(media, 0.5 * (depth + next)))) * (next - depth) * length(perDepth);
      depth = next;
    }
    if (tau > 0.0)
      listStore(uint(view.size.z) + cell, from, SHADOW_SMOKE_IDS + uint(i), ShadowNode(floatBitsToUint(to), floatBitsToUint(tau)));
  }
}
