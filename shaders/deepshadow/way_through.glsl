#include "shaders/scene/surface.glsl"
#include "shaders/shared/deepshadow.h"

// How much longer the way through a thin shell is than its thickness, as far as the material counts it. SHADOW_RIMS is defined
// when any does.
float wayThrough() {
#ifdef SHADOW_RIMS
  MaterialData material = surfaceMaterial();
  vec3 along = view.halfExtent.z != 0.0 ? vec3(0.0, 0.0, -1.0) : normalize(vPositionView);
  vec3 n = shadingNormal(material, normalize(vNormalWorld));
  float cosine = max(abs(dot(n, mat3(view.worldFromView) * along)), 0.05);
  return 1.0 + material.shadow.x * (1.0 / cosine - 1.0);
#else
  return 1.0;
#endif
}

// Optical depth of a surface of that base colour.
vec3 surfaceTau(vec4 base) {
  return min(-log(max(passThrough(base, transmission()), 1e-30)) * wayThrough(), SHADOW_OPAQUE_TAU);
}
