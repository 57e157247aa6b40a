// Between which depths something that is seen in a cell of the light lists can be lit: opaque and translucent surfaces, and
// the boxes of media up to the farthest opaque surface. A cell an invocation.
// SAMPLES is how many a pixel of the G-buffer has; SMOKE is defined when there are media; then VOLUME_COUNT says how many.
#include "shaders/lights/light_lists.glsl"
#include "shaders/lists/runs.glsl"
#include "shaders/pipelines/camera_ray.glsl"
#include "shaders/pipelines/pixel_groups.glsl"
#include "shaders/shared/linear_id.glsl"
#include "shaders/shared/math.glsl"
#include "shaders/shared/resolve_block.glsl"
#include "shaders/shared/view_block.glsl"
#ifdef SMOKE
#include "shaders/volumes/grid.glsl"
#endif

layout(std430, binding = STORAGE_RECEIVER_DEPTHS) writeonly buffer Receivers {
  vec2 receivers[];
};
layout(binding = TEXTURE_OPAQUE_DEPTH) uniform pixelSampler opaqueDepth;
layout(binding = TEXTURE_SURFACE_0) uniform pixelUsampler opaqueSurface0;

const vec2 NOTHING = vec2(3e38, -3e38);

vec2 joined(vec2 a, vec2 b) {
  return vec2(min(a.x, b.x), max(a.y, b.y));
}

// Of the opaque surface that a pixel's rays meet. `open`: one meets none.
void addDepth(float depth, inout vec2 range, inout bool open) {
  if (depth < NOTHING_SEEN) range = joined(range, vec2(depth));
  else open = true;
}

void addSamples(ivec2 pixel, inout vec2 range, inout bool open) {
  ivec2 texel = pixel - view.tile.xy;
  vec2 centre = imagePlane(view, vec2(pixel) + 0.5);
  for (int i = 0; i < SAMPLES; ++i) {
    float depth = texelFetch(opaqueDepth, texel, i).r;
    if (depth < NOTHING_SEEN) {
      vec3 normal = mat3(view.viewFromWorld) * unitFromOctahedral(unpackSnorm2x16(texelFetch(opaqueSurface0, texel, i).y));
      depth = depthOnPlane(view, normal, centre, depth, imagePlane(view, vec2(pixel) + samplePosition(params, i)));
    }
    addDepth(depth, range, open);
  }
}

// Of a pixel's translucent surfaces.
vec2 listedRange(ivec2 pixel) {
  ListRun run = listRun(listOfPixel(view, pixel));
  return run.count == 0u ? NOTHING : vec2(listDepth(run.first), listDepth(run.first + run.count - 1u));
}

#ifdef SMOKE
// Depths d at which low + d rateLow <= top, cut from `range`.
vec2 cutBelow(vec2 range, float low, float rateLow, float top) {
  if (rateLow > 0.0) range.y = min(range.y, (top - low) / rateLow);
  else if (rateLow < 0.0) range.x = max(range.x, (top - low) / rateLow);
  else if (low > top) range = NOTHING;
  return range;
}

// Where a ray through any place of a rectangle of the image can be inside a medium's box: by intervals along each axis.
vec2 mediumRange(GridData grid, vec2 planeLow, vec2 planeHigh) {
  bool orthographic = view.halfExtent.z != 0.0;
  mat4 gridFromView = grid.gridFromWorld * view.worldFromView;
  vec3 x0 = gridFromView[0].xyz * planeLow.x;
  vec3 x1 = gridFromView[0].xyz * planeHigh.x;
  vec3 y0 = gridFromView[1].xyz * planeLow.y;
  vec3 y1 = gridFromView[1].xyz * planeHigh.y;
  vec3 asideLow = min(x0, x1) + min(y0, y1);
  vec3 asideHigh = max(x0, x1) + max(y0, y1);
  vec3 forward = -gridFromView[2].xyz;
  vec3 start = gridFromView[3].xyz;
  vec3 startLow = orthographic ? start + asideLow : start;
  vec3 startHigh = orthographic ? start + asideHigh : start;
  vec3 rateLow = orthographic ? forward : forward + asideLow;
  vec3 rateHigh = orthographic ? forward : forward + asideHigh;
  vec3 slack = 1e-5 * (abs(start) + abs(grid.boxMin.xyz) + abs(grid.boxMax.xyz));
  vec2 range = view.depthRange.xy;
  for (int axis = 0; axis < 3; ++axis) {
    range = cutBelow(range, startLow[axis], rateLow[axis], grid.boxMax[axis] + slack[axis]);
    range = cutBelow(range, -startHigh[axis], -rateHigh[axis], slack[axis] - grid.boxMin[axis]);
  }
  return range.x <= range.y ? vec2(range.x * 0.9999, range.y * 1.0001) : NOTHING;
}

vec2 smokeRange(ivec2 low, ivec2 high, float farthest) {
  vec2 planeLow = imagePlane(view, vec2(low));
  vec2 planeHigh = imagePlane(view, vec2(high));
  vec2 range = NOTHING;
  for (int v = 0; v < VOLUME_COUNT; ++v) {
    vec2 ofMedium = mediumRange(grids[v], planeLow, planeHigh);
    if (ofMedium.x <= farthest) range = joined(range, ofMedium);
  }
  return vec2(range.x, min(range.y, farthest));
}
#endif

void main() {
  ivec4 window = view.window;
  ivec2 first = window.xy / LIGHT_CELL_SIDE;
  ivec2 cells = (window.xy + window.zw + LIGHT_CELL_SIDE - 1) / LIGHT_CELL_SIDE - first;
  uint number = linearId();
  if (number >= uint(cells.x * cells.y)) return;
  ivec2 cell = first + placeInRows(number, cells.x);
  ivec2 low = max(cell * LIGHT_CELL_SIDE, window.xy);
  ivec2 high = min((cell + 1) * LIGHT_CELL_SIDE, window.xy + window.zw);
  bool open = false;
  vec2 opaque = NOTHING;
  vec2 listed = NOTHING;
  // Pixels that are split are put off: few cells have any, and some drivers run for every pixel what any may need.
  ivec2 size = high - low;
  uint split = 0u;
  for (int i = 0; i < size.x * size.y; ++i) {
    ivec2 pixel = low + placeInRows(uint(i), size.x);
    if (isSplit(listOfPixel(view, pixel))) split |= 1u << i;
    else addDepth(texelFetch(opaqueDepth, pixel - view.tile.xy, 0).r, opaque, open);
    listed = joined(listed, listedRange(pixel));
  }
  while (split != 0u) {
    int i = findLSB(split);
    addSamples(low + placeInRows(uint(i), size.x), opaque, open);
    split &= split - 1u;
  }
  vec2 range = joined(opaque, listed);
#ifdef SMOKE
  range = joined(range, smokeRange(low, high, open ? NOTHING_SEEN : opaque.y));
#endif
  receivers[number] = range;
}
