// Smoke that was marched once for each block of 2 x 2 pixels of the window (smoke_blocks.comp), for the pixels in it and
// around it. Joint bilateral upsampling (Kopf, Cohen, Lischinski and Uyttendaele 2007): a block counts for a pixel where
// both look equally far into the smoke.
#include "shaders/pipelines/smoke_steps.glsl"

const float NOT_MARCHED = -1.0;  // a block's depth

layout(binding = TEXTURE_SMOKE_BLOCKS) uniform samplerBuffer smokeBlocks;  // RayState

ivec2 smokeBlockCount() {
  return (view.window.zw + 1) / 2;
}

// Depths that differ by less than this see about the same smoke.
float similarDepth(MediaRay media) {
  float stride = 3e38;
  for (int v = 0; v < MARCHED; ++v) stride = min(stride, media.stride[v]);
  return stride;
}

// Takes what the blocks around a pixel saw, weighted as bilinear interpolation would. False where they do not tell enough.
bool takeBlocks(ivec2 pixel, MediaRay media, inout vec3 radiance, inout vec3 throughput) {
  const float ENOUGH = 0.5;  // of the weights: the block of the pixel itself has 9/16, and must be among them
  float farthest = media.rangeOfAll.y;
  float similar = similarDepth(media);
  vec2 place = 0.5 * (vec2(pixel - view.window.xy) + 0.5) - 0.5;
  ivec2 low = ivec2(floor(place));
  vec2 between = place - vec2(low);
  vec3 seen = vec3(0.0);
  vec3 passed = vec3(0.0);
  float weights = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 corner = ivec2(i & 1, i >> 1);
    ivec2 block = low + corner;
    bool inside = all(greaterThanEqual(block, ivec2(0))) && all(lessThan(block, smokeBlockCount()));
    int texel = inside ? 2 * (block.y * smokeBlockCount().x + block.x) : 0;
    vec4 radianceDepth = texelFetch(smokeBlocks, texel);
    bool tells = inside && radianceDepth.w != NOT_MARCHED && abs(radianceDepth.w - farthest) <= similar;
    vec2 part = mix(1.0 - between, between, vec2(corner));
    float weight = tells ? part.x * part.y : 0.0;
    seen += weight * radianceDepth.rgb;
    passed += weight * texelFetch(smokeBlocks, texel + 1).rgb;
    weights += weight;
  }
  if (weights < ENOUGH) return false;
  radiance += throughput * seen / weights;
  throughput *= passed / weights;
  return true;
}
