// Enters a light into the list of a cell, with its front and back depth there (Lindbeck 2015, section 2.1.1). RECEIVERS is
// defined when it is known between which depths something in a cell can be lit.
#include "shaders/lights/light.glsl"
#include "shaders/lights/proxy.glsl"
#include "shaders/lists/insert.glsl"
#include "shaders/shared/view_block.glsl"

layout(std140, binding = UNIFORM_PASS) uniform Pass {
  LightPassParams params;
};
#ifdef RECEIVERS
layout(binding = TEXTURE_RECEIVER_DEPTHS) uniform usamplerBuffer receiverDepths;  // of the nearest and the farthest
#endif

// A ray through a place among the cells, in view space: start + depth * perDepth.
struct CellRay {
  vec3 start;
  vec3 perDepth;
};

CellRay cellRay(vec2 place) {
  vec2 plane = (place * float(params.cells.z) / vec2(view.size.xy) * 2.0 - 1.0) * view.halfExtent.xy;
  if (view.halfExtent.z != 0.0) return CellRay(vec3(plane, 0.0), vec3(0.0, 0.0, -1.0));
  return CellRay(vec3(0.0), vec3(plane, -1.0));
}

// Number of the light, and its back depth, rounded up to what 16 bits of a float tell.
uint nodeId(uint light, float back) {
  return light << LIGHT_NUMBER_SHIFT | (floatBitsToUint(back) + 0xffffu) >> LIGHT_NUMBER_SHIFT;
}

void enterLight(uint light, ivec2 cell) {
  CellRay ray = cellRay(vec2(cell) + 0.5);
  vec2 range;
  bool entered = proxyRange(seenInSquare(lightProxy(light, view), float(params.cells.z), view), ray.start, ray.perDepth,
                            view.depthRange.xy, range);
  ivec2 place = cell - params.window.xy;
  int number = place.y * params.window.z + place.x;
#ifdef RECEIVERS
  vec2 receivers = uintBitsToFloat(texelFetch(receiverDepths, number).xy);
  entered = entered && range.x <= receivers.y && range.y >= receivers.x;
#endif
  if (entered) listStore(uint(number), range.x, nodeId(light, range.y));
}
