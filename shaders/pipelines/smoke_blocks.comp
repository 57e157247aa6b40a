// Marches the smoke once for each block of pixels, along the ray through its middle, as far as any of them sees. Where
// surfaces stand in the smoke, knots are kept on the way. A block that has done much work goes on in the next dispatch.
// SAMPLES is how many a pixel of the G-buffer has. REFINED is defined for blocks of single pixels.
#include "shaders/pipelines/camera_ray.glsl"
#include "shaders/pipelines/pixel_groups.glsl"
#include "shaders/pipelines/smoke_blocks.glsl"
#include "shaders/pipelines/smoke_steps.glsl"
#include "shaders/pipelines/surface_runs.glsl"
#include "shaders/shared/linear_id.glsl"

layout(std430, binding = STORAGE_RAYS) buffer Blocks {
  SmokeBlock blocks[];
};
layout(std430, binding = STORAGE_SMOKE_KNOTS) writeonly buffer Knots {
  uvec4 smokeKnotsWritten[];
};
#ifdef REFINED
layout(std430, binding = STORAGE_SMOKE_PARENTS) readonly buffer Parents {
  uint parents[];
};
#endif
#ifdef COUNT_LOOKUPS
layout(std430, binding = STORAGE_LOOKUPS) buffer BlockLookups {
  uvec4 blockLookups[];  // see rays.glsl
};
#endif
layout(binding = TEXTURE_OPAQUE_DEPTH) uniform pixelSampler opaqueDepth;

// Of the pixels of a block.
struct Pixels {
  float farthest;  // opaque depth
  bool stop;       // surfaces stand in the smoke
};

Pixels pixelsOf(ivec2 first, int side, float smokeEnd) {
  Pixels pixels = Pixels(0.0, false);
  for (int i = 0; i < side * side; ++i) {
    ivec2 pixel = first + placeInRows(uint(i), side);
    if (!hasList(view, pixel)) continue;
    uint list = listOfPixel(view, pixel);
    int samples = isSplit(list) ? SAMPLES : 1;
    for (int s = 0; s < samples; ++s) {
      float depth = texelFetch(opaqueDepth, pixel - view.tile.xy, s).r;
      pixels.farthest = max(pixels.farthest, depth);
      pixels.stop = pixels.stop || depth < smokeEnd;
    }
    pixels.stop = pixels.stop || listRun(list).count != 0u;
  }
  return pixels;
}

// Of one block.
struct KnotWriter {
  uint first;
  uint count;   // that were written
  uint room;
  float apart;  // marches of STEPS from one knot to the next, so that there is room for all
  float since;  // marches since the last one
  float depth;  // behind the last of them
};

void writeKnot(inout KnotWriter knots, float depth, SmokeSeen seen) {
  vec3 radiance = min(seen.radiance, 65504.0);
  smokeKnotsWritten[knots.first + knots.count] =
      uvec4(floatBitsToUint(depth), packHalf2x16(radiance.rg), packHalf2x16(vec2(radiance.b, seen.passed.r)),
            packHalf2x16(seen.passed.gb));
  ++knots.count;
}

// After some steps that end at `depth`, with what was seen before them and behind: a knot, or where they take much of the
// light one for each, as well as where they begin. `left`: marches of STEPS that follow at most.
void writeSteps(inout KnotWriter knots, Steps steps, SmokeSeen before, SmokeSeen after, float depth, bool last, float left) {
  const float MUCH = 0.01;
  vec3 taken = before.passed - after.passed;
  uint kept = uint(left / knots.apart) + 2u;  // for those that follow
  float begin = steps.depth[0] - 0.5 * steps.size[0];
  bool parted = begin > knots.depth + 0.01 * steps.size[0];
  bool each = maxComponent(taken) > MUCH;
  knots.since += 1.0;
  if (parted && (each || knots.since >= knots.apart) && knots.count + kept + 1u < knots.room) writeKnot(knots, begin, before);
  for (int k = 0; each && k < steps.count - 1 && knots.count + kept + 1u < knots.room; ++k) {
    vec3 passed = vec3(steps.passed[0][k], steps.passed[1][k], steps.passed[2][k]);
    vec3 share = (before.passed - passed) / max(taken, 1e-6);
    writeKnot(knots, steps.depth[k] + 0.5 * steps.size[k], SmokeSeen(mix(before.radiance, after.radiance, share), passed));
  }
  if ((each || last || knots.since >= knots.apart) && knots.count + 1u < knots.room) {
    writeKnot(knots, depth, after);
    knots.since = max(knots.since - knots.apart, 0.0);
  }
  knots.depth = depth;
}

// Steps of a march up to a depth, about.
float stepsTo(MediaRay media, float end) {
  float steps = 0.0;
  for (int v = 0; v < MARCHED; ++v) steps += max(min(media.range[v].y, end) - media.range[v].x, 0.0) / media.stride[v];
  return steps;
}

void main() {
  uint number = linearId();
  if (number >= uint(params.options.w)) return;
  int side = params.blocks.x;
  ivec4 ofWindow = blocksOfWindow();
#ifdef REFINED
  ivec2 pixelParent = placeInRows(number, side * side);
  ivec2 first = side * (ofWindow.xy + placeInRows(parents[pixelParent.y], ofWindow.z)) + placeInRows(uint(pixelParent.x), side);
  uint place = uint(params.blocks.w) + number;
  side = 1;
#else
  ivec2 first = side * (ofWindow.xy + placeInRows(number, ofWindow.z));
  uint place = number;
#endif
  PixelRay ray = pixelRay(imagePlane(view, vec2(first) + 0.5 * float(side)), float(side));
  MediaRay media = mediaRay(ray.origin, ray.perDepth, view.depthRange.xy, params.march.x);
  vec2 range = media.rangeOfAll;
  bool smoky = range.x < range.y;
  Pixels pixels = Pixels(0.0, false);
  if (smoky) pixels = pixelsOf(first, side, range.y);

  float slack = depthSlack(media);
  float reach = min(pixels.farthest, range.y);
  bool stops = smoky && pixels.stop && reach > range.x;
  float limit = stops ? min(reach + slack, range.y) : reach;  // what is around it may see a little farther
  float all = stepsTo(media, limit) / float(STEPS);
  uint room = stops ? min(uint(2.0 * all) + 4u, uint(params.blocks.y)) : 0u;
  if (params.blocks.z < 0) {
    if (room != 0u) atomicAdd(counters.groups, room);
    return;
  }

  SmokeBlock block;
  if (params.options.x != 0) {
    block = SmokeBlock(0.0, 0.0, 0.0, pixels.farthest < range.y ? limit : SMOKE_ENDLESS, 1.0, 1.0, 1.0, range.x, range.x, 0u,
                       uint(params.blocks.z) + (room != 0u ? atomicAdd(counters.groups, room) : 0u), 0u);
    if (!smoky) block.reach = block.start = SMOKE_ENDLESS;
  } else {
    block = blocks[place];
  }
  vec3 radiance = vec3(block.radianceR, block.radianceG, block.radianceB);
  vec3 passed = vec3(block.passedR, block.passedG, block.passedB);
  float depth = block.depth;
  // A block may cover parts of cells of the light lists that are not the window's.
  ray.lights = lightRun(lightCell(clamp(first + side / 2, view.window.xy, view.window.xy + view.window.zw - 1), view.window));

  KnotWriter knots = KnotWriter(block.firstKnot, block.knots, room, 1.0, 0.0, depth);
  if (room != 0u) knots.apart = max(all / max(0.8 * float(room) - 2.0, 1.0), 1.0);
  bool marching = smoky && depth < limit;
  while (marching) {
    SmokeSeen before = SmokeSeen(radiance, passed);
    Steps steps = nextSteps(media, ray.metresPerDepth, limit, depth, passed);
    bool dark = maxComponent(passed) < params.march.y;
    if (steps.count > 0) {
      radiance += scattered(steps, ray);
      if (room != 0u) writeSteps(knots, steps, before, SmokeSeen(radiance, passed), depth, dark, (limit - depth) / slack);
    }
    if (dark) depth = limit;  // nothing is seen of what is left
    marching = depth < limit && work < uint(RESOLVE_WORK_LIMIT);
  }
  if (room != 0u && depth >= limit) writeKnot(knots, limit, SmokeSeen(radiance, passed));
  if (smoky && depth < limit) atomicAdd(counters.unfinished, 1u);
#ifdef COUNT_LOOKUPS
  uvec4 counted = uvec4(lookups, marched, jumped);
  blockLookups[number] = params.options.x != 0 ? counted : blockLookups[number] + counted;
#endif
  blocks[place] = SmokeBlock(radiance.r, radiance.g, radiance.b, block.reach, passed.r, passed.g, passed.b, block.start, depth,
                              0u, block.firstKnot, knots.count);
}
