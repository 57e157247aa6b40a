// Finds the pixels whose samples differ: edges of surfaces, opaque or translucent, and of their colours. Those are walked
// sample by sample, all others once through their centre.
#include "shaders/pipelines/camera_ray.glsl"
#include "shaders/pipelines/surface_runs.glsl"
#include "shaders/shared/bindings.h"
#include "shaders/shared/math.glsl"
#include "shaders/shared/resolve.h"
#include "shaders/shared/view_block.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = STORAGE_PIXEL_GROUPS) writeonly buffer Groups {
  uint pixelGroups[];
};
layout(std430, binding = STORAGE_COUNTERS) buffer Counting {
  ResolveCounters counters;
};
layout(binding = TEXTURE_OPAQUE_DEPTH) uniform pixelSampler opaqueDepth;
layout(binding = TEXTURE_SURFACE_0) uniform pixelUsampler opaqueSurface0;
layout(binding = TEXTURE_SURFACE_1) uniform pixelUsampler opaqueSurface1;

const uint LIST_LIMIT = 4096u;  // nodes looked at; a pixel with more is split anyway

bool coloursDiffer(vec3 a, vec3 b) {
  return maxComponent(abs(a - b)) > 0.02 + 0.05 * maxComponent(max(a, b));
}

bool opaqueSamplesDiffer(ivec2 texel) {
  float depth = texelFetch(opaqueDepth, texel, 0).r;
  uvec4 words = texelFetch(opaqueSurface0, texel, 0);
  vec3 normal = mat3(view.viewFromWorld) * unitFromOctahedral(unpackSnorm2x16(words.y));
  vec3 diffuse = vec3(unpackHalf2x16(words.z), unpackHalf2x16(words.w).x);
  uvec4 more = texelFetch(opaqueSurface1, texel, 0);
  vec3 emissive = vec3(unpackHalf2x16(more.z), unpackHalf2x16(more.w).x);
  float pixelWidth = 2.0 * view.halfExtent.y / float(view.size.y) * (view.halfExtent.z != 0.0 ? 1.0 : depth);
  // Facets of one surface that meet in the pixel count as well: at its centre the plane of one may lie behind the other.
  float tolerance = 0.01 * pixelWidth + 1e-5 * depth;
  bool differ = false;
  for (int i = 1; i < SAMPLES; ++i) {
    float otherDepth = texelFetch(opaqueDepth, texel, i).r;
    if ((depth < NOTHING_SEEN) != (otherDepth < NOTHING_SEEN)) differ = true;
    if (depth >= NOTHING_SEEN) continue;
    uvec4 other = texelFetch(opaqueSurface0, texel, i);
    uvec4 otherMore = texelFetch(opaqueSurface1, texel, i);
    vec3 otherNormal = mat3(view.viewFromWorld) * unitFromOctahedral(unpackSnorm2x16(other.y));
    if (abs(depth - otherDepth) > tolerance || dot(normal, otherNormal) < 0.95) differ = true;
    if (coloursDiffer(diffuse, vec3(unpackHalf2x16(other.z), unpackHalf2x16(other.w).x))) differ = true;
    if (coloursDiffer(emissive, vec3(unpackHalf2x16(otherMore.z), unpackHalf2x16(otherMore.w).x))) differ = true;
  }
  return differ;
}

bool listSamplesDiffer(uint number) {
  const uint all = (1u << SAMPLES) - 1u;
  bool differ = false;
  ListRun run = listRun(number);
  for (uint i = 0u; i < run.count && !differ; ++i)
    if ((listedCoverageObject(run.first + i) & all) != all || i == LIST_LIMIT) differ = true;
  return differ;
}

void main() {
  ivec2 pixel = view.window.xy + ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, view.window.xy + view.window.zw))) return;
  uint number = listOfPixel(view, pixel);
  uint pixels = uint(view.window.z * view.window.w);
  uint group = 0u;
  if (opaqueSamplesDiffer(pixel - view.tile.xy) || listSamplesDiffer(number)) {
    group = atomicAdd(counters.groups, 1u) + 1u;
    uint place = pixels + group - 1u;
    if (place < uint(pixelGroups.length())) pixelGroups[place] = number;
  }
  pixelGroups[number] = group;
}
