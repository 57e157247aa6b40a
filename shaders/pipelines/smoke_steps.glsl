// The march of a ray of the camera through smoke.
#include "shaders/pipelines/smoke_lighting.glsl"

uint marched = 0u;  // steps of this invocation

// Depths along a ray that differ by less see about the same smoke.
float depthSlack(MediaRay media) {
  float slack = 3e38;
  for (int v = 0; v < MARCHED; ++v) slack = min(slack, float(STEPS) * media.stride[v]);
  return slack;
}

// The next steps that hold smoke or fire, at most STEPS of them, from `depth` on and before `limit`; empty ones cost no more than
// their density. Moves the depth to the end of the last one.
Steps nextSteps(MediaRay media, float metresPerDepth, float limit, inout float depth, inout vec3 throughput) {
  Steps steps;
  steps.count = 0;
  steps.emitted = vec3(0.0);
  while (depth < limit && steps.count < STEPS && work < uint(RESOLVE_WORK_LIMIT)) {
    ++work;
    float to = stepEnd(media, depth, limit);
    float middle = 0.5 * (depth + to);
    ++marched;
    float scattered[VOLUME_COUNT];
    Extinction sigmaT = Extinction(0.0);
    for (int v = 0; v < VOLUME_COUNT; ++v) {
      scattered[v] = extinctionOf(v, media, middle);
      sigmaT += inChannels(v, scattered[v]);
    }
    vec3 emitted = emission(media, middle);
    if (maxComponent(sigmaT) > 0.0 || maxComponent(emitted) > 0.0) {
      float stepLength = (to - depth) * metresPerDepth;
      Extinction tau = sigmaT * stepLength;
      vec3 seen = throughput * seenLength(tau, stepLength);
      throughput *= exp(-tau);
      appendStep(steps, middle, to - depth, scattered, seen, throughput);
      steps.emitted += seen * emitted;
      if (maxComponent(throughput) < params.march.y) limit = to;
    } else {
      to = emptyEnd(media, depth, to, limit);
    }
    depth = to;
  }
  return steps;
}
