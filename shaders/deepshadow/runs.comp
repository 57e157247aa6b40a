// Turns the sorted list of each texel into a run of knots with the optical depth summed up, so that a lookup is a
// binary search and no walk. A texel an invocation; knots are counted, then taken from the pool, then written.
#include "shaders/deepshadow/node.glsl"
#include "shaders/shared/linear_id.glsl"
#include "shaders/shared/view.h"

layout(std140, binding = UNIFORM_PASS) uniform Pass {
  ShadowPassParams params;
};
layout(std140, binding = UNIFORM_VIEW) uniform View {
  ViewParams view;
};
layout(binding = TEXTURE_OPAQUE_DEPTH) uniform sampler2D opaqueDepth;
layout(std430, binding = STORAGE_SHADOW_TEXELS) writeonly buffer Texels {
  ShadowTexel texels[];
};
layout(std430, binding = STORAGE_SHADOW_KNOTS) writeonly buffer Knots {
  ShadowKnot knots[];
};
layout(std430, binding = STORAGE_COUNTERS) coherent buffer Counting {
  ShadowCounters counters;
};

// Knots of a texel's function from `first` on and its own steps from `firstOwn` on (see ShadowTexel), or only their
// numbers when `first` is 0xffffffff.
struct KnotWriter {
  uint first;
  uint count;
  float lastDepth;
  uint firstOwn;
  uint ownCount;
};

void emitKnot(inout KnotWriter writer, float depth, vec3 tau) {
  if (writer.first != 0xffffffffu) knots[writer.first + writer.count] = ShadowKnot(depth, tau.r, tau.g, tau.b);
  ++writer.count;
  writer.lastDepth = depth;
}

// A step from the knot that is written next to the one after it, of an object that does not shadow itself.
void emitOwnStep(inout KnotWriter writer, float depth, uint object, vec3 drop) {
  bool opaque = min(min(drop.r, drop.g), drop.b) >= SHADOW_DARK_TAU;
  if (writer.first != 0xffffffffu)
    knots[writer.firstOwn + writer.ownCount] = ShadowKnot(depth, float(object), float(writer.count), opaque ? 1.0 : 0.0);
  ++writer.ownCount;
}

KnotWriter writeKnots(uint head, uint first, uint firstOwn) {
  KnotWriter writer = KnotWriter(first, 0u, -3e38, firstOwn, 0u);
  vec3 tau = vec3(0.0);          // of everything that has ended
  vec3 smokeTau = vec3(0.0);     // of the stretch of smoke that has begun
  float smokeStart = 0.0;
  float smokeEnd = -1.0;         // < 0: none
  uint current = head;
  while (current != 0u) {
    float depth = listLinks[current].depth;
    float range = shadowNodes[current].range;
    vec3 drop = shadowNodeTau(current);
    if (smokeEnd >= 0.0 && (smokeEnd <= depth || range > 0.0)) {
      tau += smokeTau;
      emitKnot(writer, min(smokeEnd, depth), tau);
      smokeEnd = -1.0;
    }
    if (range > 0.0) {
      if (writer.lastDepth < depth) emitKnot(writer, depth, tau);
      smokeStart = depth;
      smokeEnd = depth + range;
      smokeTau = drop;
    } else if (drop != vec3(0.0)) {
      uint object = shadowNodeObject(current);
      if ((object & uint(SHADOW_NOT_SELF)) != 0u) emitOwnStep(writer, depth, object, drop);
      vec3 before = tau;
      if (smokeEnd >= 0.0) before += smokeTau * ((depth - smokeStart) / (smokeEnd - smokeStart));
      emitKnot(writer, depth, before);
      emitKnot(writer, depth, before + drop);
      tau += drop;
    }
    current = listLinks[current].next;
  }
  if (smokeEnd >= 0.0) emitKnot(writer, smokeEnd, tau + smokeTau);
  if (writer.ownCount != 0u) emitOwnStep(writer, 0.0, 0u, vec3(0.0));
  return writer;
}

void main() {
  uint cell = linearId();
  if (cell >= uint(params.range.y)) return;
  uint head = listHeads[cell];
  KnotWriter counted = writeKnots(head, 0xffffffffu, 0u);
  uint count = counted.count;
  uint all = count + counted.ownCount;
  uint first = all != 0u ? atomicAdd(counters.knots, all) : 0u;
  if (all != 0u && first + all <= uint(knots.length())) writeKnots(head, first, first + count);
  if (counted.ownCount != 0u) count |= SHADOW_OWN_STEPS;
  ivec2 place = ivec2(int(cell) % view.size.x, view.size.w + int(cell) / view.size.x);
  texels[cell] = ShadowTexel(uint(params.range.x) + first, count, texelFetch(opaqueDepth, place, 0).r);
}
