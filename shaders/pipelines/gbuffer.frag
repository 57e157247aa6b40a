// Opaque surfaces of the camera: packed surface and depth; with BASE_COLOUR that, too.
#include "shaders/scene/surface.glsl"

layout(location = 0) out uvec4 surface0;
layout(location = 1) out uvec4 surface1;
layout(location = 2) out float depth;
#ifdef BASE_COLOUR
layout(location = 3) out vec4 albedo;
#endif

void main() {
  vec4 base = baseColour();
  if (base.a == 0.0) discard;
  PackedSurface s = packSurface(base);
  surface0 = uvec4(s.normal, s.geometricNormal, s.diffuseRg, s.diffuseBRoughness);
  surface1 = uvec4(s.f0Rg, s.f0BF90, s.emissiveRg, (s.emissiveBPassR & 0xffffu) | (s.coverageObject & 0xffff0000u));
  depth = fragmentDepth();
#ifdef BASE_COLOUR
  albedo = vec4(base.rgb, 1.0);
#endif
}
