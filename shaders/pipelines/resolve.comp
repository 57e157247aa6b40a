// The frame's last pass: each ray walks its sorted surfaces front to back, marches the smoke between them and up to
// the opaque depth, and lights both through light lists and deep shadow maps. A ray that has done much work keeps
// its state and goes on in the next dispatch, because some drivers end long loops silently.
// SMOKE is defined when there are media; then VOLUME_COUNT says how many. SHADOW_OBJECTS is defined when there are
// objects that do not shadow themselves. SMOKE_BLOCKS is defined when blocks of pixels marched the smoke before. DEEP is
// defined when what each ray meets is recorded for a deep image; then the rays are those of a list. AMBIENT is defined
// when there is ambient light, SSAO when what takes it from opaque surfaces was drawn before. PASSING_RAYS is defined when
// those that no surface stops were told apart before (passing_rays.comp).
#include "shaders/pipelines/accessibility.glsl"
#include "shaders/pipelines/deep_events.glsl"
#include "shaders/pipelines/rays.glsl"
#include "shaders/pipelines/surface_lighting.glsl"
#include "shaders/pipelines/surface_runs.glsl"
#include "shaders/shared/linear_id.glsl"
#ifdef SMOKE
#include "shaders/pipelines/smoke_steps.glsl"
#endif
#ifdef SMOKE_BLOCKS
#include "shaders/pipelines/smoke_blocks.glsl"
#endif

layout(std430, binding = STORAGE_RAYS) buffer Rays {
  RayState rays[];  // of those that are walked
};
layout(binding = TEXTURE_SURFACE_0) uniform pixelUsampler opaqueSurface0;
layout(binding = TEXTURE_SURFACE_1) uniform pixelUsampler opaqueSurface1;

void main() {
  uint walked = linearId();
  if (walked >= uint(params.options.w)) return;
  bool first = params.options.x != 0;
  float depth = first ? view.depthRange.x : rays[walked].depth;
  if (depth >= RAY_FINISHED) return;
  uint number = rayNumber(walked);
  RayPlace place = rayPlace(number);
  ListRun surfaces = listRun(listOfPixel(view, place.pixel));
  uint passed = first ? 0u : rays[walked].surfaces;
  vec3 radiance = first ? vec3(0.0) : vec3(rays[walked].radianceR, rays[walked].radianceG, rays[walked].radianceB);
  vec3 throughput = first ? vec3(1.0) : vec3(rays[walked].throughputR, rays[walked].throughputG, rays[walked].throughputB);

  // Surfaces are told at the pixel's centre; a sample's ray meets their plane elsewhere.
  vec2 centre = imagePlane(view, vec2(place.pixel) + 0.5);
  vec2 plane = place.split ? imagePlane(view, vec2(place.pixel) + samplePosition(params, place.number)) : centre;
  ivec2 texel = place.pixel - view.tile.xy;
  float opaque = texelFetch(opaqueDepth, texel, place.number).r;
  uvec4 opaqueWords = texelFetch(opaqueSurface0, texel, place.number);
  if (place.split && opaque < NOTHING_SEEN) {
    vec3 normal = mat3(view.viewFromWorld) * unitFromOctahedral(unpackSnorm2x16(opaqueWords.y));
    opaque = depthOnPlane(view, normal, centre, opaque, plane);
  }
  float rayEnd = min(opaque, view.depthRange.y);

  PixelRay ray = pixelRay(plane, place.split ? 0.5 : 1.0);
  ray.lights = lightRun(lightCell(place.pixel, view.window));

#ifdef SMOKE_BLOCKS
  MediaRay media = mediaRay(ray.origin, ray.perDepth, view.depthRange.xy, params.march.x);
  vec2 position = vec2(place.pixel) + (place.split ? samplePosition(params, place.number) : vec2(0.5));
  float smokeEnd = media.rangeOfAll.y;
  BlockTaps taps;
  SmokeSeen seenBefore = SmokeSeen(vec3(0.0), vec3(1.0));
  float nearest = surfaces.count != 0u ? listDepth(surfaces.first) : rayEnd;
  bool smoky = media.rangeOfAll.x < min(smokeEnd, rayEnd);
  if (smoky) {
    taps = blockTaps(position, min(rayEnd, smokeEnd) - depthSlack(media), min(rayEnd, nearest) < smokeEnd);
    if (!first) seenBefore = seenTo(taps, depth);
  }
#elif defined(SMOKE)
  MediaRay media = mediaRay(ray.origin, ray.perDepth, vec2(view.depthRange.x, rayEnd), params.march.x);
#endif

  bool walking = true;
  while (walking && work < uint(RESOLVE_WORK_LIMIT)) {
    ++work;
    float nextSurface = rayEnd;
    if (passed < surfaces.count) {
      // Nodes stand before the farthest sample's opaque depth, not before that of each.
      float nodeDepth = listDepth(surfaces.first + passed);
      if (nodeDepth < rayEnd) nextSurface = nodeDepth;
      else passed = surfaces.count;
    }
    bool atSurface = true;
#ifdef SMOKE
    float limit = min(nextSurface, media.rangeOfAll.y);
    depth = max(depth, min(media.rangeOfAll.x, nextSurface));
#ifdef SMOKE_BLOCKS
    if (depth < limit) {
      SmokeSeen seenNow = seenTo(taps, limit);
      vec3 share = throughput / max(seenBefore.passed, 1e-6);
      radiance += share * (seenNow.radiance - seenBefore.radiance);
      throughput = share * seenNow.passed;
      seenBefore = seenNow;
      depth = limit;
    }
#else
    // All of the smoke before the next surface: some drivers run the code of surfaces in each pass of the loop around it,
    // whether or not a lane is at one.
    bool marching = depth < limit;
    while (marching) {
      Steps steps = nextSteps(media, ray.metresPerDepth, limit, depth, throughput);
      if (steps.count > 0) {
        vec3 added = scattered(steps, ray);
        radiance += added;
        recordEvent(depth - steps.size[0], depth, added, throughput);
      }
      marching = depth < limit && maxComponent(throughput) >= params.march.y && work < uint(RESOLVE_WORK_LIMIT);
    }
    // Lights of a surface are as many loops again, so that they wait for the next dispatch.
    atSurface = depth >= min(nextSurface, media.rangeOfAll.y) && work < uint(RESOLVE_WORK_LIMIT);
#endif
#endif
    if (atSurface) {
      bool listed = passed < surfaces.count;
      PackedSurface stored;
      bool seen;
      if (listed) {
        stored = listedSurface(surfaces.first + passed);
        seen = !place.split || (stored.coverageObject >> place.number & 1u) != 0u;
      } else {
        uvec4 more = texelFetch(opaqueSurface1, texel, place.number);
        stored = PackedSurface(opaqueWords.x, opaqueWords.y, opaqueWords.z, opaqueWords.w, more.x, more.y, more.z, more.w, 0u,
                               more.w & 0xffff0000u);
        seen = opaque < view.depthRange.y;
      }
      float at = listed ? nextSurface : opaque;
      if (seen) {
        Surface surface = unpackSurface(stored);
        vec2 position = vec2(place.pixel) + (place.split ? samplePosition(params, place.number) : vec2(0.5));
        float accessibility =
            listed ? 1.0 : accessibilityAt(view, position, at, surface.geometricNormal, params.ambient.w);
        vec3 added = throughput * shadeSurface(surface, ray, at, accessibility);
        radiance += added;
        if (listed) throughput *= surfacePass(stored);
        recordEvent(at, at, added, listed ? throughput : vec3(0.0));
      }
      if (listed) depth = max(depth, nextSurface);
      ++passed;
      walking = listed;
    }
    if (maxComponent(throughput) < params.march.y) walking = false;
  }
  if (walking) atomicAdd(counters.unfinished, 1u);
#ifdef COUNT_LOOKUPS
#ifdef SMOKE
  uvec4 counted = uvec4(lookups, marched, jumped);
#else
  uvec4 counted = uvec4(lookups, 0u, 0u);
#endif
  rayLookups[number] = first ? counted : rayLookups[number] + counted;
#endif
  keepSeen(number, radiance, throughput);
  rays[walked] = RayState(radiance.r, radiance.g, radiance.b, walking ? depth : RAY_FINISHED, throughput.r, throughput.g,
                          throughput.b, passed);
}
