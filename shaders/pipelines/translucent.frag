// Translucent surfaces of the camera into the lists of its pixels: those before the opaque depth of any of the
// pixel's SAMPLES, and no others.
#include "shaders/lists/linked_insert.glsl"
#include "shaders/pipelines/camera_ray.glsl"
#include "shaders/scene/surface.glsl"

layout(binding = TEXTURE_OPAQUE_DEPTH) uniform pixelSampler opaqueDepth;
layout(std430, binding = STORAGE_OLD_PAYLOADS) writeonly buffer Payloads {
  PackedSurface payloads[];
};

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float depth = fragmentDepth();
  vec4 base = baseColour();
  // Derivatives are taken before the flow diverges.
  PackedSurface surface = packSurface(base);
  float opaque = 0.0;
  for (int i = 0; i < SAMPLES; ++i) opaque = max(opaque, texelFetch(opaqueDepth, pixel, i).r);
  if (base.a > 0.0 && depth < opaque) {
    uint node = listAllocate();
    if (node != 0u) {
      payloads[node] = surface;
      listInsert(uint(view.size.z + pixel.y * view.size.x + pixel.x), node, depth, fragmentId(), 0u);
    }
  }
}
