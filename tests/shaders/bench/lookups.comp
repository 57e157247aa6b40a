// 64 lookups of the transmittance a texel, along a march: by a walk over the linked list for each (WALK), or by a cursor
// that moves forward along the run.
#include "shaders/shared/bindings.h"
#include "shaders/shared/lists.h"
#ifdef WALK
layout(std430, binding = STORAGE_LIST_HEADS) readonly buffer Heads {
  uint heads[];
};
layout(std430, binding = STORAGE_LIST_NODES) readonly buffer Links {
  ListLink links[];
};
layout(std430, binding = STORAGE_LIST_PAYLOADS) readonly buffer Payloads {
  float drops[];
};
#else
#include "shaders/lists/runs.glsl"
#endif
#include "shaders/shared/linear_id.glsl"
#include "shaders/shared/view.h"

layout(std140, binding = UNIFORM_VIEW) uniform View {
  ViewParams view;
};
layout(std430, binding = STORAGE_COUNTERS) writeonly buffer Results {
  float results[];
};

void main() {
  uint cell = linearId();
  if (cell >= uint(view.size.x * view.size.y)) return;
  float sum = 0.0;
#ifdef WALK
  for (int step = 0; step < 64; ++step) {
    float depth = (float(step) + 0.5) / 64.0;
    float tau = 0.0;
    uint node = heads[cell];
    while (node != 0u && links[node].depth <= depth) {
      tau += drops[node];
      node = links[node].next;
    }
    sum += exp(-tau);
  }
#else
  ListRun run = listRun(cell);
  uint end = run.first + run.count;
  uint node = run.first;
  float next = node < end ? listDepth(node) : 2.0;
  float tau = 0.0;
  float passing = 1.0;  // changes at nodes only
  // A step or a node at a time: lanes with a node do not keep those without waiting at every step.
  float depth = 0.5 / 64.0;
  while (depth < 1.0) {
    if (next <= depth) {
      tau += uintBitsToFloat(listPayloadWord(node));
      passing = exp(-tau);
      ++node;
      next = node < end ? listDepth(node) : 2.0;
    } else {
      sum += passing;
      depth += 1.0 / 64.0;
    }
  }
#endif
  results[cell] = sum;
}
