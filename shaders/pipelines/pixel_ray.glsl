// A ray of the camera on its walk, and the lights that may reach something along it.
#include "shaders/lights/light_lists.glsl"
#include "shaders/shared/bindings.h"
#include "shaders/shared/lists.h"
#include "shaders/shared/resolve_block.glsl"
#include "shaders/shared/view_block.glsl"

layout(std430, binding = STORAGE_COUNTERS) buffer Counting {
  ResolveCounters counters;
};

const uint LIGHT_WALK_LIMIT = 6000u;
const uint LOOP_LIMIT = 60000u;  // iterations, beyond which some drivers end loops; those of masked lookups count as well

// Tells the user when so many lights of one point, each with so many iterations, may be more than the driver runs.
void tellOfManyLights(uint lights, uint iterations) {
  if (lights == LIGHT_WALK_LIMIT || lights * iterations > LOOP_LIMIT) atomicAdd(counters.boundHit, 1u);
}

// What a pixel looks along: points are origin + depth * perDepth, in world space.
struct PixelRay {
  vec3 origin;
  vec3 perDepth;
  vec3 towardsViewer;
  float metresPerDepth;
  vec2 width;  // m, of the square that the ray stands for: x + y depth
  ListRun lights;  // of its cell
};

// Through a place of the image plane, for a square of `pixels` pixels a side; without its lights.
PixelRay pixelRay(vec2 plane, float pixels) {
  bool orthographic = view.halfExtent.z != 0.0;
  PixelRay ray;
  ray.origin = (view.worldFromView * vec4(orthographic ? vec3(plane, 0.0) : vec3(0.0), 1.0)).xyz;
  ray.perDepth = mat3(view.worldFromView) * (orthographic ? vec3(0.0, 0.0, -1.0) : vec3(plane, -1.0));
  ray.towardsViewer = -normalize(ray.perDepth);
  ray.metresPerDepth = length(ray.perDepth);
  float width = 2.0 * view.halfExtent.y / float(view.size.y) * pixels;
  ray.width = orthographic ? vec2(width, 0.0) : vec2(0.0, width);
  ray.lights = ListRun(0u, 0u);
  return ray;
}

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
