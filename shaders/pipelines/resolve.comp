// The frame's last pass: each ray walks its sorted surfaces front to back, marches the smoke between them and up to
// the opaque depth, and lights both through light lists and deep shadow maps. A ray that has done much work keeps
// its state and goes on in the next dispatch, because some drivers end long loops silently.
// SMOKE is defined when there are media; then VOLUME_COUNT says how many. SHADOW_OBJECTS is defined when there are
// objects that do not shadow themselves.
#include "shaders/deepshadow/lookup.glsl"
#include "shaders/lights/light_lists.glsl"
#include "shaders/pipelines/brdf.glsl"
#include "shaders/pipelines/camera_ray.glsl"
#include "shaders/pipelines/surface_runs.glsl"
#include "shaders/shared/resolve.h"
#include "shaders/shared/linear_id.glsl"
#ifdef SMOKE
#include "shaders/volumes/media.glsl"
#endif

layout(std140, binding = UNIFORM_VIEW) uniform View {
  ViewParams view;
};
layout(std140, binding = UNIFORM_PASS) uniform Pass {
  ResolveParams params;
};
layout(std430, binding = STORAGE_RAYS) buffer Rays {
  RayState rays[];
};
layout(std430, binding = STORAGE_PIXEL_GROUPS) readonly buffer Groups {
  uint pixelGroups[];
};
layout(std430, binding = STORAGE_COUNTERS) buffer Counting {
  ResolveCounters counters;
};
layout(binding = TEXTURE_OPAQUE_DEPTH) uniform pixelSampler opaqueDepth;
layout(binding = TEXTURE_SURFACE_0) uniform pixelUsampler opaqueSurface0;
layout(binding = TEXTURE_SURFACE_1) uniform pixelUsampler opaqueSurface1;

const float FINISHED = 3e38;
const uint LIGHT_WALK_LIMIT = 6000u;  // keeps one point's lighting below the drivers' loop limit

// What a pixel looks along: points are origin + depth * perDepth, in world space.
struct PixelRay {
  vec3 origin;
  vec3 perDepth;
  vec3 towardsViewer;
  float metresPerDepth;
  vec2 width;  // m, of the square that the ray stands for: x + y depth
  ListRun lights;  // of its cell
};

uint work = 0u;  // loop iterations of this invocation, about

vec3 reflectedFrom(uint number, Surface surface, vec3 p, vec3 toViewer) {
  LightData light = lights[number];
  vec3 toLight;
  vec3 irradiance = lightFrom(light, p, toLight);
  float cosine = dot(surface.normal, toLight);
  if (maxComponent(irradiance) <= 0.0 || cosine <= 0.0 || dot(surface.geometricNormal, toLight) <= 0.0) return vec3(0.0);
  if (light.indices.y >= 0)
    irradiance *= shadowOnSurface(light.indices.y, light.indices.z, light.position.xyz, p, surface.geometricNormal, surface.object);
  return brdf(surface, toLight, toViewer) * irradiance * cosine;
}

// Those that may reach something in the pixel: the directional ones, then its cell's list. One loop over both keeps a
// shader that drivers take a second to compile from holding everything twice.
uint lightsOf(PixelRay ray) {
  return uint(params.options.z) + ray.lights.count;
}

ListedLight lightOf(PixelRay ray, uint i) {
  uint directional = uint(params.options.z);
  return i < directional ? ListedLight(i, -3e38, 3e38) : listedLight(ray.lights.first + i - directional);
}

// Emitted and reflected radiance towards the viewer, lit by every light that reaches it.
vec3 shadeSurface(Surface surface, PixelRay ray, float depth) {
  vec3 p = ray.origin + depth * ray.perDepth;
  vec3 sum = surface.emissive;
  bool reached = true;
  uint walked = 0u;
  while (reached && walked < min(lightsOf(ray), LIGHT_WALK_LIMIT)) {
    ListedLight at = lightOf(ray, walked);
    reached = at.front <= depth;
    if (reached && depth <= at.back) sum += reflectedFrom(at.light, surface, p, ray.towardsViewer);
    ++walked;
    work += 16u;
  }
  if (walked == LIGHT_WALK_LIMIT) atomicAdd(counters.boundHit, 1u);
  return sum;
}

#ifdef SMOKE
// Up to four steps of the march, lit together so that what describes a light is read once for all of them.
// Component k of each vector is step k; a step that is not there scatters nothing.
const int STEPS = 4;

struct Steps {
  int count;
  vec4 depth;                    // of its middle
  vec4 size;                     // in depth
  vec4 scattered[VOLUME_COUNT];  // sigma_t of each medium times the length over which it is seen
  vec4 throughput[3];            // of the ray before the step: red, green, blue
};

void appendStep(inout Steps steps, float depth, float size, float scattered[VOLUME_COUNT], vec3 throughput) {
  int k = steps.count;
  steps.depth[k] = depth;
  steps.size[k] = size;
  for (int v = 0; v < VOLUME_COUNT; ++v) steps.scattered[v][k] = scattered[v];
  for (int c = 0; c < 3; ++c) steps.throughput[c][k] = throughput[c];
  ++steps.count;
}

// What the media turn from light that travels along `direction` towards the viewer.
vec3 turned(Steps steps, int k, vec3 direction, vec3 towardsViewer) {
  vec3 sum = vec3(0.0);
  for (int v = 0; v < VOLUME_COUNT; ++v) {
    float phase = phaseHenyeyGreenstein(dot(direction, towardsViewer), volumes[v].phase.x);
    sum += volumes[v].albedoScale.rgb * (steps.scattered[v][k] * phase);
  }
  return sum;
}

// Integral of 1 / |p| over the rectangle between the origin and a corner, odd in both coordinates.
float inverseDistance(vec2 corner) {
  vec2 size = max(abs(corner), 1e-6);
  return corner.x * asinh(corner.y / size.x) + corner.y * asinh(corner.x / size.y);
}

// How far a ray passes a lamp: the harmonic mean over the square that it stands for, whose middle is `miss` away, m.
float distancePassed(PixelRay ray, vec3 miss, float depth) {
  float width = ray.width.x + depth * ray.width.y;
  float exact = length(miss);
  if (exact > 4.0 * width) return exact;
  vec2 middle = vec2(dot(miss, view.worldFromView[0].xyz), dot(miss, view.worldFromView[1].xyz)) / width;
  float mean = inverseDistance(middle + vec2(0.5)) - inverseDistance(middle + vec2(0.5, -0.5)) -
               inverseDistance(middle + vec2(-0.5, 0.5)) + inverseDistance(middle - vec2(0.5));
  return width / mean;
}

// Mean over step k of what a lamp close by adds to it. Its irradiance peaks where the ray passes it, so that the step is
// cut at equal angles as the lamp sees them (Kulla and Fajardo 2012).
vec3 turnedFromNearby(LightData light, Steps steps, int k, PixelRay ray) {
  const int CUTS = 4;
  vec3 middle = ray.origin + steps.depth[k] * ray.perDepth;
  float halfLength = 0.5 * steps.size[k] * ray.metresPerDepth;
  float nearest = dot(middle - light.position.xyz, ray.towardsViewer);  // to where the ray passes the lamp
  vec3 miss = middle - nearest * ray.towardsViewer - light.position.xyz;
  float away = distancePassed(ray, miss, steps.depth[k]);
  vec3 passed = length(miss) > 1e-3 * away ? away * normalize(miss) : away * view.worldFromView[0].xyz;
  float first = atan((-halfLength - nearest) / away);
  float last = atan((halfLength - nearest) / away);
  vec3 sum = vec3(0.0);
  for (int i = 0; i < CUTS; ++i) {
    float angle = mix(first, last, (float(i) + 0.5) / float(CUTS));
    vec3 fromLight = passed - away * tan(angle) * ray.towardsViewer;
    vec3 toLight;
    vec3 irradiance = lightFrom(light, light.position.xyz + fromLight, toLight);
    sum += irradiance * dot(fromLight, fromLight) * turned(steps, k, -toLight, ray.towardsViewer);
  }
  return sum * (last - first) / (float(CUTS) * 2.0 * halfLength * away);
}

// Radiance that a light adds to the ray over the steps between its front and back depth.
vec3 scatteredFrom(uint number, Steps steps, PixelRay ray, float front, float back) {
  LightData light = lights[number];
  bool shadowed = light.indices.y >= 0;
  bool cube = light.indices.z == 6;
  ShadowFace face;
  vec3 start = vec3(0.0);
  vec3 perDepth = vec3(0.0);
  if (shadowed) {
    face = shadowFaces[light.indices.y];
    start = (face.faceFromWorld * vec4(ray.origin, 1.0)).xyz;
    perDepth = mat3(face.faceFromWorld) * ray.perDepth;
  }
  vec3 sum = vec3(0.0);
  for (int k = 0; k < steps.count; ++k) {
    float depth = steps.depth[k];
    if (depth < front || depth > back) continue;
    vec3 p = ray.origin + depth * ray.perDepth;
    vec3 toLight;
    vec3 added = lightFrom(light, p, toLight);
    if (maxComponent(added) > 0.0) {
      float stepLength = steps.size[k] * ray.metresPerDepth;
      vec3 distances = light.position.xyz - p;
      bool nearby = light.indices.x != LIGHT_DIRECTIONAL && dot(distances, distances) < 16.0 * stepLength * stepLength;
      if (nearby) added = turnedFromNearby(light, steps, k, ray);
      else added *= turned(steps, k, -toLight, ray.towardsViewer);
      if (shadowed) {
        vec3 pFace = start + depth * perDepth;
        ShadowFace seen = face;
        if (cube) {
          // All six look alike but for their axes.
          int side = faceTowards(6, p - light.position.xyz);
          seen.texels.x += side * face.texels.y * face.texels.y;
          pFace = inCubeFace(side, p - light.position.xyz);
        }
        added *= shadowInSmoke(seen, pFace, params.options.y != 0);
      }
      vec3 throughput = vec3(steps.throughput[0][k], steps.throughput[1][k], steps.throughput[2][k]);
      sum += throughput * added;
    }
  }
  work += uint(8 * STEPS);
  return sum;
}

vec3 scattered(Steps steps, PixelRay ray) {
  vec3 sum = vec3(0.0);
  float farthest = steps.depth[steps.count - 1];
  bool reached = true;
  uint walked = 0u;
  while (reached && walked < min(lightsOf(ray), LIGHT_WALK_LIMIT)) {
    ListedLight at = lightOf(ray, walked);
    reached = at.front <= farthest;
    if (reached) sum += scatteredFrom(at.light, steps, ray, at.front, at.back);
    ++walked;
  }
  if (walked == LIGHT_WALK_LIMIT) atomicAdd(counters.boundHit, 1u);
  return sum;
}
#endif

// Which pixel and which of its samples a ray goes through; `split`: the pixel's samples have a ray each.
struct RayPlace {
  ivec2 pixel;  // of the image
  int number;  // of the sample
  bool split;
};

RayPlace rayPlace(uint ray) {
  uint pixels = uint(view.window.z * view.window.w);
  uint pixel = ray;
  int number = 0;
  bool split = false;
  if (ray < pixels) {
    split = pixelGroups[ray] != 0u;
  } else {
    pixel = pixelGroups[pixels + (ray - pixels) / uint(SAMPLES - 1)];
    number = 1 + int((ray - pixels) % uint(SAMPLES - 1));
    split = true;
  }
  ivec2 place = ivec2(int(pixel) % view.window.z, int(pixel) / view.window.z);
  return RayPlace(view.window.xy + place, number, split);
}

void main() {
  uint number = linearId();
  if (number >= uint(params.options.w)) return;
  bool first = params.options.x != 0;
  float depth = first ? view.depthRange.x : rays[number].depth;
  if (depth >= FINISHED) return;
  RayPlace place = rayPlace(number);
  ListRun surfaces = listRun(listOfPixel(view, place.pixel));
  uint passed = first ? 0u : rays[number].surfaces;
  vec3 radiance = first ? vec3(0.0) : vec3(rays[number].radianceR, rays[number].radianceG, rays[number].radianceB);
  vec3 throughput = first ? vec3(1.0) : vec3(rays[number].throughputR, rays[number].throughputG, rays[number].throughputB);

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

  bool orthographic = view.halfExtent.z != 0.0;
  PixelRay ray;
  ray.origin = (view.worldFromView * vec4(orthographic ? vec3(plane, 0.0) : vec3(0.0), 1.0)).xyz;
  ray.perDepth = mat3(view.worldFromView) * (orthographic ? vec3(0.0, 0.0, -1.0) : vec3(plane, -1.0));
  ray.towardsViewer = -normalize(ray.perDepth);
  ray.metresPerDepth = length(ray.perDepth);
  float width = 2.0 * view.halfExtent.y / float(view.size.y) * (place.split ? 0.5 : 1.0);
  ray.width = orthographic ? vec2(width, 0.0) : vec2(0.0, width);
  ray.lights = lightRun(lightCell(place.pixel, view.window));

#ifdef SMOKE
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
    // Collect the next steps that hold smoke; empty ones cost no more than their density.
    Steps steps;
    steps.count = 0;
    float limit = min(nextSurface, media.rangeOfAll.y);
    depth = max(depth, min(media.rangeOfAll.x, nextSurface));
    while (depth < limit && steps.count < STEPS && work < uint(RESOLVE_WORK_LIMIT)) {
      ++work;
      float to = stepEnd(media, depth, limit);
      float middle = 0.5 * (depth + to);
      float scattered[VOLUME_COUNT];
      float sigmaT = 0.0;
      for (int v = 0; v < VOLUME_COUNT; ++v) {
        scattered[v] = extinctionOf(v, media, middle);
        sigmaT += scattered[v];
      }
      if (sigmaT > 0.0) {
        float tau = sigmaT * (to - depth) * ray.metresPerDepth;
        float passed = exp(-tau);
        // Integral of exp(-sigmaT s) over the step; its series where the difference would cancel.
        float seenLength = tau > 1e-3 ? (1.0 - passed) / sigmaT : (tau / sigmaT) * (1.0 - 0.5 * tau);
        for (int v = 0; v < VOLUME_COUNT; ++v) scattered[v] *= seenLength;
        appendStep(steps, middle, to - depth, scattered, throughput);
        throughput *= passed;
        if (maxComponent(throughput) < params.march.y) limit = to;
      }
      depth = to;
    }
    if (steps.count > 0) radiance += scattered(steps, ray);
    atSurface = depth >= min(nextSurface, media.rangeOfAll.y);
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
      if (seen) radiance += throughput * shadeSurface(unpackSurface(stored), ray, listed ? nextSurface : opaque);
      if (listed && seen) throughput *= surfacePass(stored);
      if (listed) depth = max(depth, nextSurface);
      ++passed;
      walking = listed;
    }
    if (maxComponent(throughput) < params.march.y) walking = false;
  }
  if (walking) atomicAdd(counters.unfinished, 1u);
  rays[number] = RayState(radiance.r, radiance.g, radiance.b, walking ? depth : FINISHED, throughput.r, throughput.g,
                          throughput.b, passed);
}
