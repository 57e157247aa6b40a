// The frame's last pass: each pixel walks its sorted surfaces front to back, marches the smoke between them and up to
// the opaque depth, and lights both through light lists and deep shadow maps. A pixel that has done much work keeps
// its state and goes on in the next dispatch, because some drivers end long loops silently.
// SMOKE is defined when there are media; then VOLUME_COUNT says how many.
#include "shaders/deepshadow/lookup.glsl"
#include "shaders/lights/light_lists.glsl"
#include "shaders/pipelines/brdf.glsl"
#include "shaders/shared/resolve.h"
#include "shaders/shared/view.h"
#ifdef SMOKE
#include "shaders/volumes/media.glsl"
#endif

layout(local_size_x = 8, local_size_y = 8) in;
layout(std140, binding = UNIFORM_VIEW) uniform View {
  ViewParams view;
};
layout(std140, binding = UNIFORM_PASS) uniform Pass {
  ResolveParams params;
};
layout(std430, binding = STORAGE_PIXELS) buffer Pixels {
  PixelState pixels[];
};
layout(std430, binding = STORAGE_COUNTERS) buffer Counting {
  ResolveCounters counters;
};
layout(std430, binding = STORAGE_LIST_HEADS) readonly buffer SurfaceHeads {
  uint surfaceHeads[];
};
layout(std430, binding = STORAGE_LIST_LINKS) readonly buffer SurfaceLinks {
  ListLink surfaceLinks[];
};
layout(std430, binding = STORAGE_LIST_PAYLOADS) readonly buffer SurfaceNodes {
  PackedSurface surfaceNodes[];
};
layout(binding = TEXTURE_OPAQUE_DEPTH) uniform sampler2D opaqueDepth;
layout(binding = TEXTURE_SURFACE_0) uniform usampler2D opaqueSurface0;
layout(binding = TEXTURE_SURFACE_1) uniform usampler2D opaqueSurface1;

const float FINISHED = 3e38;
const uint LIGHT_WALK_LIMIT = 6000u;  // keeps one point's lighting below the drivers' loop limit

// What a pixel looks along: points are origin + depth * perDepth, in world space.
struct PixelRay {
  vec3 origin;
  vec3 perDepth;
  vec3 towardsViewer;
  uint cell;  // of the light lists
};

uint work = 0u;  // loop iterations of this invocation, about

vec3 reflectedFrom(uint light, Surface surface, vec3 p, vec3 toViewer) {
  vec3 toLight;
  vec3 irradiance = lightAt(light, p, toLight);
  float cosine = dot(surface.normal, toLight);
  if (maxComponent(irradiance) <= 0.0 || cosine <= 0.0 || dot(surface.geometricNormal, toLight) <= 0.0) return vec3(0.0);
  ivec4 indices = lights[light].indices;
  if (indices.y >= 0)
    irradiance *= shadowOnSurface(indices.y, indices.z, lights[light].position.xyz, p, surface.geometricNormal);
  return brdf(surface, toLight, toViewer) * irradiance * cosine;
}

// Emitted and reflected radiance towards the viewer, lit by every light that reaches it.
vec3 shadeSurface(Surface surface, PixelRay ray, float depth) {
  vec3 p = ray.origin + depth * ray.perDepth;
  vec3 sum = surface.emissive;
  for (uint light = 0u; light < uint(params.options.z); ++light) {
    sum += reflectedFrom(light, surface, p, ray.towardsViewer);
    work += 16u;
  }
  uint walked = 0u;
  uint node = lightCellHeads[ray.cell];
  while (node != 0u && walked < LIGHT_WALK_LIMIT && lightCellLinks[node].depth <= depth) {
    if (depth <= lightCellBacks[node]) sum += reflectedFrom(lightCellLinks[node].id, surface, p, ray.towardsViewer);
    node = lightCellLinks[node].next;
    ++walked;
    work += 16u;
  }
  if (walked == LIGHT_WALK_LIMIT) atomicAdd(counters.boundHit, 1u);
  return sum;
}

#ifdef SMOKE
// What scatters at a point, 1/m.
struct Scatterer {
  vec3 sigmaS[VOLUME_COUNT];
};

// Radiance that a light adds to the ray per metre: sigma_s * phase * irradiance.
vec3 scatteredFrom(uint light, Scatterer scatterer, vec3 p, vec3 towardsViewer) {
  vec3 toLight;
  vec3 irradiance = lightAt(light, p, toLight);
  if (maxComponent(irradiance) <= 0.0) return vec3(0.0);
  ivec4 indices = lights[light].indices;
  if (indices.y >= 0)
    irradiance *= shadowInSmoke(indices.y, indices.z, lights[light].position.xyz, p, params.options.y != 0);
  vec3 turned = vec3(0.0);
  for (int v = 0; v < VOLUME_COUNT; ++v)
    turned += scatterer.sigmaS[v] * phaseHenyeyGreenstein(dot(-toLight, towardsViewer), volumes[v].phase.x);
  return turned * irradiance;
}

vec3 scattered(Scatterer scatterer, PixelRay ray, float depth) {
  vec3 p = ray.origin + depth * ray.perDepth;
  vec3 sum = vec3(0.0);
  for (uint light = 0u; light < uint(params.options.z); ++light) {
    sum += scatteredFrom(light, scatterer, p, ray.towardsViewer);
    work += 8u;
  }
  uint walked = 0u;
  uint node = lightCellHeads[ray.cell];
  while (node != 0u && walked < LIGHT_WALK_LIMIT && lightCellLinks[node].depth <= depth) {
    if (depth <= lightCellBacks[node]) sum += scatteredFrom(lightCellLinks[node].id, scatterer, p, ray.towardsViewer);
    node = lightCellLinks[node].next;
    ++walked;
    work += 8u;
  }
  if (walked == LIGHT_WALK_LIMIT) atomicAdd(counters.boundHit, 1u);
  return sum;
}
#endif

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (pixel.x >= view.size.x || pixel.y >= view.size.y) return;
  uint number = uint(pixel.y * view.size.x + pixel.x);
  bool first = params.options.x != 0;
  float depth = first ? view.depthRange.x : pixels[number].depth;
  if (depth >= FINISHED) return;
  uint node = first ? surfaceHeads[number] : pixels[number].node;
  vec3 radiance = first ? vec3(0.0) : vec3(pixels[number].radianceR, pixels[number].radianceG, pixels[number].radianceB);
  vec3 throughput = first ? vec3(1.0) : vec3(pixels[number].throughputR, pixels[number].throughputG, pixels[number].throughputB);

  vec2 plane = ((vec2(pixel) + 0.5) / vec2(view.size.xy) * 2.0 - 1.0) * view.halfExtent.xy;
  bool orthographic = view.halfExtent.z != 0.0;
  PixelRay ray;
  ray.origin = (view.worldFromView * vec4(orthographic ? vec3(plane, 0.0) : vec3(0.0), 1.0)).xyz;
  ray.perDepth = mat3(view.worldFromView) * (orthographic ? vec3(0.0, 0.0, -1.0) : vec3(plane, -1.0));
  ray.towardsViewer = -normalize(ray.perDepth);
  ray.cell = lightCell(pixel, view.size.x);
  float opaque = texelFetch(opaqueDepth, pixel, 0).r;
  float rayEnd = min(opaque, view.depthRange.y);

#ifdef SMOKE
  float metresPerDepth = length(ray.perDepth);
  MediaRay media = mediaRay(ray.origin, ray.perDepth, vec2(view.depthRange.x, rayEnd));
  float stride = params.march.x / metresPerDepth;
#endif

  bool walking = true;
  while (walking && work < uint(RESOLVE_WORK_LIMIT)) {
    ++work;
    float nextSurface = rayEnd;
    if (node != 0u) nextSurface = surfaceLinks[node].depth;
    bool atSurface = true;
#ifdef SMOKE
    float from = max(depth, media.rangeOfAll.x);
    float limit = min(nextSurface, media.rangeOfAll.y);
    if (from < limit) {
      // Steps stand at multiples of the stride from where the ray enters, cut at surfaces, so that adding a pane does
      // not move them.
      float index = floor((from - media.rangeOfAll.x) / stride + 1e-3);
      float to = min(media.rangeOfAll.x + (index + 1.0) * stride, limit);
      if (to <= from) to = min(from + stride, limit);
      if (to <= from) to = limit;  // a stride below the depth's rounding
      float middle = 0.5 * (from + to);
      Scatterer scatterer;
      float sigmaT = 0.0;
      for (int v = 0; v < VOLUME_COUNT; ++v) {
        float sigma = extinctionOf(v, media, middle);
        sigmaT += sigma;
        scatterer.sigmaS[v] = sigma * volumes[v].albedoScale.rgb;
      }
      if (sigmaT > 0.0) {
        float tau = sigmaT * (to - from) * metresPerDepth;
        float passed = exp(-tau);
        // Integral of exp(-sigmaT s) over the step; its series where the difference would cancel.
        float length_ = tau > 1e-3 ? (1.0 - passed) / sigmaT : (tau / sigmaT) * (1.0 - 0.5 * tau);
        radiance += throughput * length_ * scattered(scatterer, ray, middle);
        throughput *= passed;
      }
      depth = to;
      atSurface = false;
    }
#endif
    if (atSurface && node != 0u) {
      PackedSurface stored = surfaceNodes[node];
      radiance += throughput * shadeSurface(unpackSurface(stored), ray, nextSurface);
      throughput *= surfacePass(stored);
      depth = max(depth, nextSurface);
      node = surfaceLinks[node].next;
    } else if (atSurface) {
      if (opaque < view.depthRange.y) {
        uvec4 a = texelFetch(opaqueSurface0, pixel, 0);
        uvec4 b = texelFetch(opaqueSurface1, pixel, 0);
        PackedSurface stored = PackedSurface(a.x, a.y, a.z, a.w, b.x, b.y, b.z, b.w, 0u);
        radiance += throughput * shadeSurface(unpackSurface(stored), ray, opaque);
      }
      walking = false;
    }
    if (maxComponent(throughput) < params.march.y) walking = false;
  }
  if (walking) atomicAdd(counters.unfinished, 1u);
  pixels[number] = PixelState(radiance.r, radiance.g, radiance.b, walking ? depth : FINISHED, throughput.r, throughput.g,
                              throughput.b, node);
}
