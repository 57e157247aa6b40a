// What a fragment of a mesh is made of: factors, textures and vertex colour of its glTF material.
#include "shaders/scene/draws.glsl"
#include "shaders/scene/pass_through.glsl"
#include "shaders/shared/view_block.glsl"

layout(binding = TEXTURE_BASE_COLOUR) uniform sampler2D baseColourTexture;
layout(binding = TEXTURE_TRANSMISSION) uniform sampler2D transmissionTexture;

#ifdef COVERING
#include "shaders/scene/covered_surface.glsl"
#else
in vec3 vPositionView;
in vec3 vNormalWorld;
in vec4 vTangentWorld;
in vec2 vUv0;
in vec2 vUv1;
in vec4 vColour;
flat in uint vDraw;
#endif

// See DrawData.
ivec4 drawIndices() {
  return drawAt(vDraw).indices;
}

MaterialData surfaceMaterial() {
  return materialAt(drawIndices().x);
}

// Unique among the fragments of one pixel, ascending with (draw, primitive).
uint fragmentId() {
  return uint(drawIndices().y + gl_PrimitiveID);
}

float fragmentDepth() {
  return -vPositionView.z;
}

// A texture of the material, where its use reads it. TEXTURES is defined when any material has one: drivers take long to
// compile what samples textures. Gradients are taken of what is interpolated, not of what
// the material made of it: the lanes beside a triangle, which they need, may read no storage.
vec4 materialTexture(sampler2D image, int unit) {
#ifdef TEXTURES
  MaterialData material = surfaceMaterial();
  bool second = (material.flags.y >> unit & 1) != 0;
  vec3 uRow = material.uvTransforms[2 * unit].xyz;
  vec3 vRow = material.uvTransforms[2 * unit + 1].xyz;
  vec3 uv = vec3(second ? vUv1 : vUv0, 1.0);
  vec4 gradient0 = vec4(dFdx(vUv0), dFdy(vUv0));
  vec4 gradient1 = vec4(dFdx(vUv1), dFdy(vUv1));
  vec4 gradient = second ? gradient1 : gradient0;
  return textureGrad(image, vec2(dot(uRow, uv), dot(vRow, uv)),
                     vec2(dot(uRow.xy, gradient.xy), dot(vRow.xy, gradient.xy)),
                     vec2(dot(uRow.xy, gradient.zw), dot(vRow.xy, gradient.zw)));
#else
  return vec4(1.0);
#endif
}

// Linear base colour; alpha is coverage: 1 where the material is not BLEND, and cut at the cutoff for MASK.
vec4 baseColour() {
  MaterialData material = surfaceMaterial();
  vec4 colour = material.baseColour * vColour * materialTexture(baseColourTexture, TEXTURE_BASE_COLOUR);
  if ((material.flags.x & MATERIAL_MASK) != 0) colour.a = colour.a < material.emissive.w ? 0.0 : 1.0;
  else if ((material.flags.x & MATERIAL_BLEND) == 0) colour.a = 1.0;
  return colour;
}

// Of an opaque surface: whether MASK cuts it out. MASKS is defined when any material does.
bool isCutOut() {
#ifdef MASKS
  return baseColour().a == 0.0;
#else
  return false;
#endif
}

float transmission() {
  return surfaceMaterial().factors.w * materialTexture(transmissionTexture, TEXTURE_TRANSMISSION).r;
}
