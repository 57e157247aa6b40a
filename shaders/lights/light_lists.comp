// Enters all lights into the lists of a tile of cells, a cell an invocation: some lights at a time are asked whether they
// touch the tile at all, and those that do whether they touch each cell.
#include "shaders/lights/cell_light.glsl"

layout(local_size_x = LIGHT_TILE_SIDE, local_size_y = LIGHT_TILE_SIDE) in;

const uint LIGHTS_AT_A_TIME = uint(LIGHT_TILE_SIDE * LIGHT_TILE_SIDE);

shared uint touching;  // of those that are looked at
shared uint touchingLights[LIGHTS_AT_A_TIME];

// Whether a ray through some cell of the tile can meet what its light is entered for there.
bool touchesTile(uint light, CellRay middle) {
  Proxy ofCell = seenInSquare(lightProxy(light, view), float(params.cells.z), view);
  Proxy ofTile = seenInSquare(ofCell, float(params.cells.z * LIGHT_TILE_SIDE), view);
  vec2 range;
  return proxyRange(ofTile, middle.start, middle.perDepth, view.depthRange.xy, range);
}

void main() {
  ivec2 tile = ivec2(gl_WorkGroupID.xy) * LIGHT_TILE_SIDE;
  ivec2 place = tile + ivec2(gl_LocalInvocationID.xy);
  bool hasList = all(lessThan(place, params.window.zw));
  CellRay middle = cellRay(vec2(params.window.xy + tile) + 0.5 * float(LIGHT_TILE_SIDE));
  uint first = uint(params.cells.w) + gl_WorkGroupID.z * uint(LIGHTS_OF_A_GROUP);
  uint last = min(first + uint(LIGHTS_OF_A_GROUP), lightCount());
  for (uint some = first; some < last; some += LIGHTS_AT_A_TIME) {
    if (gl_LocalInvocationIndex == 0u) touching = 0u;
    barrier();
    uint light = some + gl_LocalInvocationIndex;
    if (light < last && touchesTile(light, middle)) touchingLights[atomicAdd(touching, 1u)] = light;
    barrier();
    if (hasList)
      for (uint i = 0u; i < touching; ++i) enterLight(touchingLights[i], params.window.xy + place);
    barrier();
  }
}
