// The smoke as blocks of pixels saw it (smoke_blocks.comp, SmokeBlock), for the pixels in them and around them: what a pixel
// sees up to a depth is interpolated from what the blocks around it saw up to there.
#include "shaders/shared/division.glsl"
#include "shaders/shared/resolve_block.glsl"
#include "shaders/shared/view_block.glsl"

layout(binding = TEXTURE_SMOKE_BLOCKS) uniform samplerBuffer smokeBlocks;
layout(binding = TEXTURE_SMOKE_KNOTS) uniform usamplerBuffer smokeKnots;

// Blocks of the window: the first one's place, and how many across and down.
ivec4 blocksOfWindow() {
  int side = params.blocks.x;
  ivec2 first = quotient(view.window.xy, side);
  return ivec4(first, quotient(view.window.xy + view.window.zw + side - 1, side) - first);
}

// From the viewer to a depth.
struct SmokeSeen {
  vec3 radiance;
  vec3 passed;
};

SmokeSeen seenAtKnot(uvec4 knot) {
  vec2 mixed = unpackHalf2x16(knot.z);
  return SmokeSeen(vec3(unpackHalf2x16(knot.y), mixed.x), vec3(mixed.y, unpackHalf2x16(knot.w)));
}

// Of a block up to a depth; a little beyond its last knot the smoke goes on as it did before.
SmokeSeen seenByBlock(int number, float depth) {
  vec4 radianceReach = texelFetch(smokeBlocks, 3 * number);
  vec4 passedStart = texelFetch(smokeBlocks, 3 * number + 1);
  vec4 rest = texelFetch(smokeBlocks, 3 * number + 2);
  SmokeSeen before = SmokeSeen(vec3(0.0), vec3(1.0));
  int first = floatBitsToInt(rest.z);
  int knots = floatBitsToInt(rest.w);
  int low = 0;
  int high = knots;  // knots [0, low) stand at or before depth, knots [high, knots) behind it
  while (low < high) {
    int middle = (low + high) >> 1;
    if (uintBitsToFloat(texelFetch(smokeKnots, first + middle).x) <= depth) low = middle + 1;
    else high = middle;
  }
  if (knots == 0 || (low == knots && radianceReach.w == SMOKE_ENDLESS))
    return SmokeSeen(radianceReach.rgb, passedStart.rgb);
  if (depth <= passedStart.w) return before;
  low = min(low, knots - 1);
  uvec4 knot = texelFetch(smokeKnots, first + low);
  SmokeSeen after = seenAtKnot(knot);
  float from = passedStart.w;
  if (low > 0) {
    uvec4 last = texelFetch(smokeKnots, first + low - 1);
    from = uintBitsToFloat(last.x);
    before = seenAtKnot(last);
  }
  float part = min((depth - from) / (uintBitsToFloat(knot.x) - from), 2.0);
  vec3 left = after.passed / max(before.passed, 1e-20);  // from knot to knot
  vec3 leftThere = pow(left, vec3(part));
  vec3 shown = mix((1.0 - leftThere) / max(1.0 - left, 1e-6), vec3(part), greaterThan(left, vec3(0.99)));
  return SmokeSeen(before.radiance + shown * (after.radiance - before.radiance), before.passed * leftThere);
}

// The blocks around a place, and how much each counts.
struct BlockTaps {
  ivec4 block;
  vec4 weight;
  SmokeSeen whole;  // of all the smoke that they tell of
  bool stops;       // see blockTaps
};

// For a ray through a position of the image; `stops`: surfaces stand before or in the smoke, so that it must be known up to
// them. Blocks that do not reach that depth do not count, or what is behind an edge would show beside it (joint bilateral
// upsampling: Kopf, Cohen, Lischinski and Uyttendaele 2007); that of the pixel itself always does, and alone if it was
// refined.
BlockTaps blockTaps(vec2 position, float reach, bool stops) {
  ivec4 blocks = blocksOfWindow();
  vec2 place = position / float(params.blocks.x) - vec2(blocks.xy);
  ivec2 own = ivec2(place);
  ivec2 low = ivec2(floor(place - 0.5));
  vec2 between = place - 0.5 - vec2(low);
  BlockTaps taps = BlockTaps(ivec4(0), vec4(0.0), SmokeSeen(vec3(0.0), vec3(0.0)), stops);
  float weights = 0.0;
  uint refined = 0u;
  for (int i = 0; i < 4; ++i) {
    ivec2 corner = ivec2(i & 1, i >> 1);
    ivec2 at = clamp(low + corner, ivec2(0), blocks.zw - 1);
    int number = at.y * blocks.z + at.x;
    vec4 radianceReach = texelFetch(smokeBlocks, 3 * number);
    vec4 passedStart = texelFetch(smokeBlocks, 3 * number + 1);
    vec4 rest = texelFetch(smokeBlocks, 3 * number + 2);
    bool tells = radianceReach.w >= reach &&
                 (!stops || floatBitsToInt(rest.w) > 0 || passedStart.w == SMOKE_ENDLESS);
    vec2 part = mix(1.0 - between, between, vec2(corner));
    float weight = tells || at == own ? part.x * part.y : 0.0;
    taps.block[i] = number;
    taps.weight[i] = weight;
    taps.whole.radiance += weight * radianceReach.rgb;
    taps.whole.passed += weight * passedStart.rgb;
    weights += weight;
    if (at == own) refined = floatBitsToUint(rest.y);
  }
  taps.weight /= weights;
  taps.whole.radiance /= weights;
  taps.whole.passed /= weights;
  if (refined != 0u) {
    ivec2 inBlock = ivec2((place - vec2(own)) * float(params.blocks.x));
    int number = int(refined) + inBlock.y * params.blocks.x + inBlock.x;
    taps.block = ivec4(number);
    taps.weight = vec4(1.0, 0.0, 0.0, 0.0);
    taps.whole = SmokeSeen(texelFetch(smokeBlocks, 3 * number).rgb, texelFetch(smokeBlocks, 3 * number + 1).rgb);
  }
  return taps;
}

SmokeSeen seenTo(BlockTaps taps, float depth) {
  if (!taps.stops) return taps.whole;
  SmokeSeen sum = SmokeSeen(vec3(0.0), vec3(0.0));
  for (int i = 0; i < 4; ++i) {
    SmokeSeen seen = seenByBlock(taps.block[i], depth);
    sum.radiance += taps.weight[i] * seen.radiance;
    sum.passed += taps.weight[i] * seen.passed;
  }
  return sum;
}
