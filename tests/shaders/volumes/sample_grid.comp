// Samples grid 0 at points of its index space; tests/volumes/grids_gpu_test.cpp asks.
#include "shaders/shared/linear_id.glsl"
#include "shaders/volumes/grid.glsl"

struct Probe {
  vec4 point;      // xyz: where, as index positions
  vec4 direction;  // xyz: and which way
};

layout(std430, binding = 0) readonly buffer Probes {
  Probe probes[];
};
layout(std430, binding = 1) writeonly buffer Answers {
  vec2 answers[];  // the value, and how far nothing comes along the direction
};

void main() {
  if (linearId() >= uint(probes.length())) return;
  Probe probe = probes[linearId()];
  vec3 p = (grids[0].gridFromWorld * vec4(probe.point.xyz, 1.0)).xyz;
  vec3 rate = (grids[0].gridFromWorld * vec4(probe.direction.xyz, 0.0)).xyz;
  answers[linearId()] = vec2(sampleGrid(0, p), emptyFilledUntil(0, p, rate, 0.0).x);
}
