// Light that passes several surfaces of an object that shadows once is attenuated by the first one: the others of that
// object in a texel's sorted list are made to take nothing. A texel an invocation; of each object only the first node
// walks on through the list, so the work is nodes times objects.
#include "shaders/deepshadow/node.glsl"
#include "shaders/shared/linear_id.glsl"

layout(std140, binding = UNIFORM_PASS) uniform Pass {
  ShadowPassParams params;
};
layout(std430, binding = STORAGE_COUNTERS) coherent buffer Counting {
  ShadowCounters counters;
};

const uint WALK_LIMIT = 60000u;  // below the drivers' loop limit

void main() {
  uint cell = linearId();
  if (cell >= uint(params.range.y)) return;
  uint walked = 0u;
  uint current = listHeads[cell];
  while (current != 0u && walked < WALK_LIMIT) {
    uint object = shadowNodeObject(current);
    uint later = (object & uint(SHADOW_ONCE)) != 0u ? listLinks[current].next : 0u;
    while (later != 0u && walked < WALK_LIMIT) {
      if (shadowNodeObject(later) == object) {
        shadowNodes[later].tauRg = 0u;
        shadowNodes[later].tauBObject = 0u;
      }
      later = listLinks[later].next;
      ++walked;
    }
    current = listLinks[current].next;
    ++walked;
  }
  if (walked == WALK_LIMIT) atomicAdd(counters.boundHit, 1u);
}
