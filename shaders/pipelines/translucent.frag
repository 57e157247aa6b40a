// Translucent surfaces of the camera into the lists of its pixels: those before the opaque depth of any of the
// pixel's SAMPLES, and no others.
#define LIST_PAYLOAD PackedSurface
#include "shaders/shared/surface.h"
#include "shaders/lists/insert.glsl"
#include "shaders/pipelines/camera_ray.glsl"
#include "shaders/scene/surface.glsl"

layout(binding = TEXTURE_OPAQUE_DEPTH) uniform pixelSampler opaqueDepth;

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);  // of the tile's G-buffer
  float depth = fragmentDepth();
  vec4 base = baseColour();
  // Derivatives are taken before the flow diverges.
  PackedSurface surface = packSurface(base);
  float opaque = 0.0;
  for (int i = 0; i < SAMPLES; ++i) opaque = max(opaque, texelFetch(opaqueDepth, texel, i).r);
  ivec2 pixel = texel + view.tile.xy;
  if (base.a > 0.0 && depth < opaque && hasList(view, pixel))
    listStore(listOfPixel(view, pixel), depth, fragmentId(), surface);
}
