// Finds the blocks of smoke that differ too much from one beside them for what is between them to be told from both: at hard
// edges of the smoke or of shadows in it, and around lamps. Each pixel of these gets a block of its own.
#include "shaders/pipelines/pixel_ray.glsl"
#include "shaders/pipelines/smoke_blocks.glsl"
#include "shaders/shared/linear_id.glsl"

layout(std430, binding = STORAGE_RAYS) buffer Blocks {
  SmokeBlock blocks[];
};
layout(std430, binding = STORAGE_SMOKE_PARENTS) writeonly buffer Parents {
  uint parents[];
};

const float ALIKE = 0.1;      // of transmittance
const float AS_BRIGHT = 0.5;  // of what is brighter
const float THIN = 0.02;      // takes so little that what it scatters may differ

// Of what smoke scatters, whatever there is of it.
vec3 brightness(SmokeSeen seen) {
  return seen.radiance / max(1.0 - seen.passed, THIN);
}

bool areAlike(SmokeSeen a, SmokeSeen b) {
  vec3 brightA = brightness(a);
  vec3 brightB = brightness(b);
  bool thin = all(greaterThan(min(a.passed, b.passed), vec3(1.0 - 2.0 * THIN)));
  return all(lessThan(abs(a.passed - b.passed), vec3(ALIKE))) &&
         (thin || all(lessThanEqual(abs(brightA - brightB), AS_BRIGHT * max(brightA, brightB))));
}

void main() {
  uint number = linearId();
  if (number >= uint(params.options.w)) return;
  ivec4 ofWindow = blocksOfWindow();
  ivec2 own = placeInRows(number, ofWindow.z);
  float reach = texelFetch(smokeBlocks, 3 * int(number)).w;
  bool alike = true;
  for (int i = 0; i < 9 && alike; ++i) {
    ivec2 at = clamp(own + ivec2(i % 3, i / 3) - 1, ivec2(0), ofWindow.zw - 1);
    int other = at.y * ofWindow.z + at.x;
    float depth = min(reach, texelFetch(smokeBlocks, 3 * other).w);
    alike = areAlike(seenByBlock(int(number), depth), seenByBlock(other, depth));
  }
  if (!alike) {
    uint place = atomicAdd(counters.groups, 1u);
    parents[place] = number;
    blocks[number].refined = uint(params.blocks.w) + place * uint(params.blocks.x * params.blocks.x);
  }
}
