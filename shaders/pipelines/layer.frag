// The nearest surfaces into a layer (pipelines/layers_gpu.h). TRANSLUCENT is defined for those that let light pass,
// INTERLACE where they take some pixels only, IN_FRONT where what is behind the opaque surfaces is left out, NUMBERED where
// the number of the fragment is kept, PEELED where what is not behind such a layer is left out, TABLE_STORAGE for targets
// of 8 and 10 bits. ROUTED where all fragments are kept, with what orders them, in the samples of a part of the image, and
// PAGED where those of earlier pages are left out (pipelines/stencil_routed_gpu.h); COVERING where triangles came as
// rectangles (scene/covering.geom).
#include "shaders/scene/surface.glsl"
#include "shaders/shared/layers.h"
#ifdef INTERLACE
#include "shaders/pipelines/interlace.glsl"
#endif

#ifdef IN_FRONT
layout(binding = TEXTURE_OPAQUE_DEPTH) uniform sampler2D opaqueDepth;
#endif
#ifdef PEELED
layout(binding = TEXTURE_PEELED_DEPTH) uniform sampler2D peeledDepth;
layout(binding = TEXTURE_PEELED_ID) uniform usampler2D peeledId;
#endif

#ifdef TABLE_STORAGE
layout(location = 0) out vec4 colour;
layout(location = 1) out vec4 normal;
layout(location = 2) out vec4 material;
#else
layout(location = 0) out uvec4 surface0;
layout(location = 1) out uvec4 surface1;
layout(location = 2) out uvec2 surface2;
#endif
#ifdef ROUTED
layout(location = 3) out uvec2 key;
#else
layout(location = 3) out float depth;
#endif
#ifdef PAGED
layout(binding = TEXTURE_ROUTED_PAGE) uniform usampler2D pageEnd;  // numbers of the last fragments that are kept
#endif
#ifdef NUMBERED
layout(location = 4) out uint id;
#endif

bool isWanted(ivec2 pixel, float at) {
#ifdef COVERING
  if (!isCovered(pixel)) return false;
#endif
#ifdef INTERLACE
  if (!maybeTranslucent(pixel)) return false;
#endif
#ifdef IN_FRONT
  if (at >= texelFetch(opaqueDepth, pixel, 0).r) return false;
#endif
#ifdef PAGED
  if (fragmentId() <= texelFetch(pageEnd, pixel - view.tile.xy, 0).r) return false;
#endif
#ifdef PEELED
  float peeled = texelFetch(peeledDepth, pixel, 0).r;
  if (at < peeled || (at == peeled && fragmentId() <= texelFetch(peeledId, pixel, 0).r)) return false;
#endif
  return true;
}

void main() {
  float at = fragmentDepth();
  SurfacePoint point = surfacePoint(baseColour());  // derivatives are taken before the flow diverges
  if (point.base.a == 0.0 || !isWanted(ivec2(gl_FragCoord.xy) + view.tile.xy, at)) discard;
#ifdef TRANSLUCENT
  bool translucent = true;
#else
  bool translucent = false;
#endif
#ifdef TABLE_STORAGE
  colour = vec4(sqrt(point.base.rgb), point.base.a);
  normal = vec4(0.5 + 0.5 * point.normal, translucent ? 1.0 : 0.0);
  material = vec4(point.specular, point.roughness, point.metallic, point.tau);
#else
  point.coverageObject = (point.coverageObject & 0xffff0000u) | (translucent ? LAYER_TRANSLUCENT : 0u);
  PackedSurface s = packedSurface(point);
  surface0 = uvec4(s.normal, s.geometricNormal, s.diffuseRg, s.diffuseBRoughness);
  surface1 = uvec4(s.f0Rg, s.f0BF90, s.emissiveRg, s.emissiveBPassR);
  surface2 = uvec2(s.passGb, s.coverageObject);
#endif
#ifdef ROUTED
  key = uvec2(floatBitsToUint(at), fragmentId());
#else
  depth = at;
#endif
#ifdef NUMBERED
  id = fragmentId();
  // So that the depth test orders fragments as lists do: by what is told of their depth, then as they are drawn.
  gl_FragDepth = at * view.depthRange.z;
#endif
}
