// Enters a light into the list of a cell, with its front and back depth there (Lindbeck 2015, section 2.1.1). Only the
// far side of the proxy counts: it covers every cell once, also with the camera inside the light.
#define LIST_PAYLOAD float  // back depth
#include "shaders/lights/light.glsl"
#include "shaders/lights/proxy.glsl"
#include "shaders/lists/insert.glsl"
#include "shaders/shared/view.h"

layout(std140, binding = UNIFORM_VIEW) uniform View {
  ViewParams view;
};
layout(std140, binding = UNIFORM_PASS) uniform Pass {
  LightPassParams params;
};

flat in uint vLight;

void main() {
  ivec2 cell = ivec2(gl_FragCoord.xy);
  vec2 plane = (gl_FragCoord.xy * float(params.cells.z) / vec2(view.size.xy) * 2.0 - 1.0) * view.halfExtent.xy;
  bool orthographic = view.halfExtent.z != 0.0;
  vec3 start = orthographic ? vec3(plane, 0.0) : vec3(0.0);
  vec3 perDepth = orthographic ? vec3(0.0, 0.0, -1.0) : vec3(plane, -1.0);
  vec2 range;
  if (!gl_FrontFacing && proxyRange(lightProxy(vLight, view, params), start, perDepth, view.depthRange.xy, range)) {
    ivec2 place = cell - params.window.xy;
    listStore(uint(place.y * params.window.z + place.x), range.x, vLight, range.y);
  }
}
