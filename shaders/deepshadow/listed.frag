// Translucent surfaces, and opaque ones that do not shadow themselves, into the lists of a light's texels, as far as
// light gets there at all.
#define LIST_PAYLOAD ShadowNode
#include "shaders/shared/deepshadow.h"
#include "shaders/lists/insert.glsl"
#include "shaders/scene/surface.glsl"

layout(binding = TEXTURE_OPAQUE_DEPTH) uniform sampler2D opaqueDepth;

// How much longer the way through a thin shell is than its thickness, as far as the material counts it.
float wayThrough() {
  MaterialData material = materials[materialNumber()];
  if (material.shadow.x == 0.0) return 1.0;
  vec3 along = view.halfExtent.z != 0.0 ? vec3(0.0, 0.0, -1.0) : normalize(vPositionView);
  vec3 n = shadingNormal(material, normalize(vNormalWorld));
  float cosine = max(abs(dot(n, mat3(view.worldFromView) * along)), 0.05);
  return 1.0 + material.shadow.x * (1.0 / cosine - 1.0);
}

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  float depth = fragmentDepth();
  vec4 base = baseColour();
  vec3 pass = passThrough(base, transmission());
  if (base.a > 0.0 && depth < texelFetch(opaqueDepth, texel, 0).r) {
    vec3 tau = min(-log(max(pass, 1e-30)) * wayThrough(), SHADOW_OPAQUE_TAU);
    uint object = uint(draws[vDraw].indices.z);
    ShadowNode node = ShadowNode(packHalf2x16(tau.rg), packHalf2x16(vec2(tau.b, 0.0)) | object << 16);
    listStore(uint(view.size.z + texel.y * view.size.x + texel.x), depth, fragmentId(), node);
  }
}
