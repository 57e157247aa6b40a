// Translucent surfaces of the camera into the lists of its pixels: those before the opaque depth, and no others.
#include "shaders/lists/insert.glsl"
#include "shaders/scene/surface.glsl"

layout(binding = TEXTURE_OPAQUE_DEPTH) uniform sampler2D opaqueDepth;
layout(std430, binding = STORAGE_LIST_PAYLOADS) writeonly buffer Payloads {
  PackedSurface payloads[];
};

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float depth = fragmentDepth();
  vec4 base = baseColour();
  // Derivatives are taken before the flow diverges.
  PackedSurface surface = packSurface(base);
  if (base.a > 0.0 && depth < texelFetch(opaqueDepth, pixel, 0).r) {
    uint node = listAllocate();
    if (node != 0u) {
      payloads[node] = surface;
      listInsert(uint(view.size.z + pixel.y * view.size.x + pixel.x), node, depth, fragmentId(), 0u);
    }
  }
}
