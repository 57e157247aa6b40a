// Marches the smoke of one shadow face, a texel an invocation, from the light to the opaque depth, and writes as few
// nodes as keep the transmittance within the error bound (Lokovic and Veach 2000, section 3.2, here on the optical
// depth, so that a node is an exponential and homogeneous smoke takes one).
#include "shaders/deepshadow/node.glsl"
#include "shaders/shared/view.h"
#include "shaders/volumes/media.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(std140, binding = UNIFORM_VIEW) uniform View {
  ViewParams view;
};
layout(std140, binding = UNIFORM_PASS) uniform Pass {
  ShadowPassParams params;
};
layout(std430, binding = STORAGE_COUNTERS) coherent buffer Counting {
  ShadowCounters counters;
};
layout(binding = TEXTURE_OPAQUE_DEPTH) uniform sampler2D opaqueDepth;

const float DARK_TAU = 16.0;        // exp(-16) is nothing
const float MAX_STEPS = 16384.0;

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy) + ivec2(0, view.size.w);
  if (texel.x >= view.size.x || texel.y >= view.size.y) return;
  uint cell = uint(view.size.z + texel.y * view.size.x + texel.x);
  vec2 plane = ((vec2(texel) + 0.5) / vec2(view.size.xy) * 2.0 - 1.0) * view.halfExtent.xy;
  bool orthographic = view.halfExtent.z != 0.0;
  vec3 originView = orthographic ? vec3(plane, 0.0) : vec3(0.0);
  vec3 perDepthView = orthographic ? vec3(0.0, 0.0, -1.0) : vec3(plane, -1.0);
  vec3 origin = (view.worldFromView * vec4(originView, 1.0)).xyz;
  vec3 perDepth = mat3(view.worldFromView) * perDepthView;
  float metresPerDepth = length(perDepth);

  float opaque = texelFetch(opaqueDepth, texel, 0).r;
  MediaRay ray = mediaRay(origin, perDepth, vec2(0.0, opaque), params.march.x);
  float start = ray.rangeOfAll.x;
  float end = ray.rangeOfAll.y;
  if (start >= end) return;
  float tooMany = stepsAtMost(ray) / MAX_STEPS;
  if (tooMany > 1.0) {
    atomicAdd(counters.boundHit, 1u);
    for (int v = 0; v < VOLUME_COUNT; ++v) ray.stride[v] *= tooMany;
  }
  float bound = params.march.y;

  float tau = 0.0;
  uint id = SMOKE_ID;
  uint hint = 0u;
  float depth = start;
  while (depth < end && tau < DARK_TAU) {
    // Empty steps cost no more than their density.
    float sigma = 0.0;
    while (depth < end && sigma == 0.0) {
      float to = stepEnd(ray, depth, end);
      sigma = extinction(ray, 0.5 * (depth + to));
      if (sigma == 0.0) depth = to;
    }
    // A segment starts at (segmentDepth, segmentTau); any slope in [slopeMin, slopeMax] stays within the bound. It ends
    // where none is left, where the smoke ends, or where it is dark.
    float segmentDepth = depth;
    float segmentTau = tau;
    float slopeMin = 0.0;
    float slopeMax = 3e38;
    bool open = depth < end;
    while (open) {
      float to = depth < end ? stepEnd(ray, depth, end) : depth;
      sigma = depth < end ? extinction(ray, 0.5 * (depth + to)) : 0.0;
      float nextTau = tau + sigma * (to - depth) * metresPerDepth;
      // tau may be off by -log(1 + x) to -log(1 - x), x = bound / T; these lie within, and need no logarithm.
      float x = bound * exp(nextTau);
      float run = to - segmentDepth;
      float tauMin = nextTau - x / (1.0 + x);
      float tauMax = nextTau + x;
      float newMin = max(slopeMin, (tauMin - segmentTau) / run);
      float newMax = min(slopeMax, (tauMax - segmentTau) / run);
      open = sigma > 0.0 && tau < DARK_TAU;
      if ((!open || newMin > newMax) && depth > segmentDepth) {
        float range = depth - segmentDepth;
        float drop = range * clamp((tau - segmentTau) / range, slopeMin, slopeMax);
        uint node = insertShadowNode(cell, segmentDepth, range, vec3(drop), 0u, id, hint);
        if (node != 0u) hint = node;
        ++id;
        segmentDepth = depth;
        segmentTau += drop;
        newMin = max(0.0, (tauMin - segmentTau) / (to - depth));
        newMax = (tauMax - segmentTau) / (to - depth);
      }
      if (open) {
        slopeMin = newMin;
        slopeMax = max(newMin, newMax);
        tau = nextTau;
        depth = to;
      }
    }
  }
}
