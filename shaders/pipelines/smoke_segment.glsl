// A ray of the camera that is taken on from surface to surface, through the smoke between them.
#include "shaders/pipelines/pixel_ray.glsl"
#ifdef SMOKE
#include "shaders/pipelines/smoke_steps.glsl"
#endif

struct Walker {
  vec3 radiance;
  vec3 throughput;
  float depth;  // how far it has come
  uint layers;  // that it has passed
  bool ended;
};

Walker walkerOf(RayState state) {
  return Walker(vec3(state.radianceR, state.radianceG, state.radianceB),
                vec3(state.throughputR, state.throughputG, state.throughputB), state.depth, state.surfaces,
                state.depth >= RAY_FINISHED);
}

RayState stateOf(Walker walker) {
  return RayState(walker.radiance.r, walker.radiance.g, walker.radiance.b, walker.ended ? RAY_FINISHED : walker.depth,
                  walker.throughput.r, walker.throughput.g, walker.throughput.b, walker.layers);
}

// Through the smoke up to a depth; false where that is more work than one dispatch may do. The steps are those of a walk
// that nothing interrupts.
bool marchTo(float end, PixelRay ray, inout Walker walker) {
#ifdef SMOKE
  MediaRay media = mediaRay(ray.origin, ray.perDepth, vec2(view.depthRange.x, end), params.march.x);
  float limit = min(end, media.rangeOfAll.y);
  walker.depth = max(walker.depth, min(media.rangeOfAll.x, end));
  while (walker.depth < limit && work < uint(RESOLVE_WORK_LIMIT)) {
    ++work;
    Steps steps = nextSteps(media, ray.metresPerDepth, limit, walker.depth, walker.throughput);
    if (steps.count > 0) walker.radiance += scattered(steps, ray);
    if (maxComponent(walker.throughput) < params.march.y) {
      walker.ended = true;
      return true;
    }
  }
  if (walker.depth < limit) return false;
#endif
  walker.depth = max(walker.depth, end);
  return true;
}
