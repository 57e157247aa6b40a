// Marches the smoke before the opaque depth once for each block of 2 x 2 pixels, along the ray through its middle: where
// the four see about as far into the smoke, no translucent surface stands in them, and none is walked sample by sample.
#include "shaders/pipelines/camera_ray.glsl"
#include "shaders/pipelines/smoke_blocks.glsl"
#include "shaders/pipelines/surface_runs.glsl"
#include "shaders/shared/linear_id.glsl"

layout(std430, binding = STORAGE_RAYS) writeonly buffer Blocks {
  RayState blocks[];
};
layout(std430, binding = STORAGE_PIXEL_GROUPS) readonly buffer Groups {
  uint pixelGroups[];
};
layout(binding = TEXTURE_OPAQUE_DEPTH) uniform pixelSampler opaqueDepth;

void main() {
  uint number = linearId();
  if (number >= uint(params.options.w)) return;
  int across = smokeBlockCount().x;
  ivec2 first = view.window.xy + 2 * ivec2(int(number) % across, int(number) / across);
  PixelRay ray = pixelRay(imagePlane(view, vec2(first) + 1.0), 2.0);
  ray.lights = lightRun(lightCell(first, view.window));
  MediaRay media = mediaRay(ray.origin, ray.perDepth, view.depthRange.xy, params.march.x);

  bool alike = media.rangeOfAll.x < media.rangeOfAll.y;
  vec2 reach = vec2(3e38, -3e38);
  for (int i = 0; i < 4; ++i) {
    ivec2 pixel = first + ivec2(i & 1, i >> 1);
    bool whole = hasList(view, pixel);
    uint list = whole ? listOfPixel(view, pixel) : 0u;
    alike = alike && whole && pixelGroups[list] == 0u && listRun(list).count == 0u;
    float depth = min(texelFetch(opaqueDepth, pixel - view.tile.xy, 0).r, media.rangeOfAll.y);
    reach = vec2(min(reach.x, depth), max(reach.y, depth));
  }
  alike = alike && reach.y - reach.x <= similarDepth(media);

  float limit = 0.5 * (reach.x + reach.y);
  media = mediaRay(ray.origin, ray.perDepth, vec2(view.depthRange.x, limit), params.march.x);
  float depth = media.rangeOfAll.x;
  vec3 radiance = vec3(0.0);
  vec3 throughput = vec3(1.0);
  while (alike && depth < limit && work < uint(RESOLVE_WORK_LIMIT) && maxComponent(throughput) >= params.march.y) {
    Steps steps = nextSteps(media, ray.metresPerDepth, limit, depth, throughput);
    if (steps.count > 0) radiance += scattered(steps, ray);
  }
  bool done = alike && work < uint(RESOLVE_WORK_LIMIT);
  blocks[number] = RayState(radiance.r, radiance.g, radiance.b, done ? limit : NOT_MARCHED, throughput.r, throughput.g,
                            throughput.b, 0u);
}
