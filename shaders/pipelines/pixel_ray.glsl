// A ray of the camera on its walk, and the lights that may reach something along it.
#include "shaders/lights/light_lists.glsl"
#include "shaders/shared/bindings.h"
#include "shaders/shared/lists.h"
#include "shaders/shared/resolve.h"
#include "shaders/shared/view.h"

layout(std140, binding = UNIFORM_VIEW) uniform View {
  ViewParams view;
};
layout(std140, binding = UNIFORM_PASS) uniform Pass {
  ResolveParams params;
};
layout(std430, binding = STORAGE_COUNTERS) buffer Counting {
  ResolveCounters counters;
};

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

#ifdef COUNT_LOOKUPS
uvec2 lookups = uvec2(0u);  // of this invocation; x: lights asked, y: shadows
#define COUNT_LOOKUP(of) ++lookups.of
#else
#define COUNT_LOOKUP(of)
#endif

uint work = 0u;  // loop iterations of this invocation, about

// Those that may reach something in the pixel: the directional ones, then its cell's list. One loop over both keeps a
// shader that drivers take a second to compile from holding everything twice.
uint lightsOf(PixelRay ray) {
  return uint(params.options.z) + ray.lights.count;
}

ListedLight lightOf(PixelRay ray, uint i) {
  COUNT_LOOKUP(x);
  uint directional = uint(params.options.z);
#ifdef WALK_LISTS
  if (i >= directional) return walkedLight(ray.lights, i - directional);
#endif
  return i < directional ? ListedLight(i, -3e38, 3e38) : listedLight(ray.lights.first + i - directional);
}
