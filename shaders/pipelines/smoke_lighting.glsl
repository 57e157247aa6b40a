// Light in smoke and from fire.
#include "shaders/deepshadow/shadows.glsl"
#include "shaders/pipelines/multiple_scattering.glsl"
#include "shaders/pipelines/pixel_ray.glsl"
#include "shaders/volumes/fire.glsl"
#include "shaders/volumes/media.glsl"

// Up to four steps of the march, lit together so that what describes a light is read once for all of them.
// Component k of each vector is step k; a step that is not there scatters nothing. DEEP wants to know of each by itself.
#ifdef DEEP
const int STEPS = 1;
#else
const int STEPS = 4;
#endif

struct Steps {
  int count;
  vec4 depth;                    // of its middle
  vec4 size;                     // in depth
  vec4 scattered[VOLUME_COUNT];  // sigma_t of each medium
  vec4 seen[3];                  // throughput of the ray before the step, times the length over which the step is seen, m
  vec4 passed[3];                // throughput behind it
  vec3 emitted;                  // by fires in all of them, as the viewer sees it
};

void appendStep(inout Steps steps, float depth, float size, float scattered[VOLUME_COUNT], vec3 seen, vec3 passed) {
  int k = steps.count;
  steps.depth[k] = depth;
  steps.size[k] = size;
  for (int v = 0; v < VOLUME_COUNT; ++v) steps.scattered[v][k] = scattered[v];
  for (int c = 0; c < 3; ++c) {
    steps.seen[c][k] = seen[c];
    steps.passed[c][k] = passed[c];
  }
  ++steps.count;
}

vec3 seenOf(Steps steps, int k) {
  return vec3(steps.seen[0][k], steps.seen[1][k], steps.seen[2][k]);
}

// What the media turn from light that travels along `direction` towards the viewer; `passing` of it gets there.
vec3 turned(Steps steps, int k, vec3 direction, vec3 towardsViewer, vec3 passing) {
  vec3 sum = vec3(0.0);
  for (int v = 0; v < VOLUME_COUNT; ++v)
    sum += volumes[v].scattering.rgb * steps.scattered[v][k] * turnedByMedium(v, dot(direction, towardsViewer), passing);
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

// Steps that are close to a lamp.
struct Nearby {
  uint light;
  uint steps;       // a bit each
  vec4 passing[3];  // of its light, to each
};

// Mean over step k of what a lamp close by adds to it. Its irradiance peaks where the ray passes it, so that the step is
// cut at equal angles as the lamp sees them (Kulla and Fajardo 2012).
vec3 turnedFromNearby(LightData light, Steps steps, int k, PixelRay ray, vec3 passing) {
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
    sum += irradiance * dot(fromLight, fromLight) * turned(steps, k, -toLight, ray.towardsViewer, passing);
  }
  return sum * (last - first) / (float(CUTS) * 2.0 * halfLength * away);
}

// Radiance that a light adds to the ray over the steps between its front and back depth, but for those close to it.
vec3 scatteredFrom(uint number, Steps steps, PixelRay ray, float front, float back, inout Nearby nearby) {
  LightData light = lightAt(number);
  bool shadowed = light.indices.y >= 0;
  bool cube = light.indices.z == 6;
  ShadowFace face;
  vec3 start = vec3(0.0);
  vec3 perDepth = vec3(0.0);
  if (shadowed) {
    face = shadowFaceAt(light.indices.y);
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
      vec3 passing = vec3(1.0);
      if (shadowed) {
        vec3 pFace = start + depth * perDepth;
        ShadowFace seen = face;
        if (cube) {
          // All six look alike but for their axes.
          int side = faceTowards(6, p - light.position.xyz);
          seen.texels.x += side * texelsOfFace(face);
          pFace = inCubeFace(side, p - light.position.xyz);
        }
        COUNT_LOOKUP(y);
        passing = shadowInSmoke(seen, pFace, params.options.y >> 3);
      }
      float stepLength = steps.size[k] * ray.metresPerDepth;
      vec3 distances = light.position.xyz - p;
      if (light.indices.x != LIGHT_DIRECTIONAL && dot(distances, distances) < 16.0 * stepLength * stepLength) {
        nearby.light = number;
        nearby.steps |= 1u << k;
        for (int c = 0; c < 3; ++c) nearby.passing[c][k] = passing[c];
      } else {
        sum += seenOf(steps, k) * added * turned(steps, k, -toLight, ray.towardsViewer, passing);
      }
    }
  }
  work += uint(8 * STEPS);
  return sum;
}

vec3 scattered(Steps steps, PixelRay ray) {
  vec3 sum = steps.emitted;
  float farthest = steps.depth[steps.count - 1];
  uint listed = min(lightsOf(ray), LIGHT_WALK_LIMIT);
  bool reached = true;
  uint walked = 0u;
  // Steps close to a lamp are put off until the lights around it are done, because some drivers run what few of them need for
  // all.
  while (reached && walked < listed) {
    Nearby nearby = Nearby(0u, 0u, vec4[3](vec4(0.0), vec4(0.0), vec4(0.0)));
    while (reached && walked < listed && nearby.steps == 0u) {
      ListedLight at = lightOf(ray, walked);
      reached = at.front <= farthest;
      if (reached) sum += scatteredFrom(at.light, steps, ray, at.front, at.back, nearby);
      ++walked;
    }
    while (nearby.steps != 0u) {
      int k = findLSB(nearby.steps);
      nearby.steps &= nearby.steps - 1u;
      vec3 passing = vec3(nearby.passing[0][k], nearby.passing[1][k], nearby.passing[2][k]);
      sum += seenOf(steps, k) * turnedFromNearby(lightAt(nearby.light), steps, k, ray, passing);
    }
  }
  tellOfManyLights(walked, 40u);
  return sum;
}
