// Meshes and materials, as scene/geometry_gpu uploads them.
#pragma once
#include "shaders/shared/glsl.h"
SHARED_BEGIN

// One instance of one mesh.
struct DrawData {
  mat4 worldFromObject;
  mat4 normalFromObject;  // inverse transpose, upper 3x3
  ivec4 indices;          // x: material, y: number of its first primitive among those of all draws, z: SHADOW_*
};

#define MATERIAL_TEXTURES 7  // units TEXTURE_BASE_COLOUR to TEXTURE_SPECULAR_COLOUR

struct MaterialData {
  vec4 baseColour;      // linear, alpha
  vec4 emissive;        // rgb; w: alpha cutoff
  vec4 specularColour;  // rgb; w: specular factor
  vec4 factors;         // metallic, roughness, normal scale, transmission
  ivec4 flags;          // x: MATERIAL_*, y: bit n: texture unit n reads the second uv set
  vec4 shadow;          // x: how much longer the way through a shell is counted at its rim
  vec4 uvTransforms[2 * MATERIAL_TEXTURES];  // two rows for each unit: what stands to the left of (u, v, 1, 0)
};

SHARED_END

#define MATERIAL_MASK 1
#define MATERIAL_BLEND 2
#define MATERIAL_NORMAL_MAP 4

// An instance whose material says how it shadows: its number from 1 on, and what was said. 0: nothing was.
#define SHADOW_OBJECT_LIMIT 0x3fff
#define SHADOW_NOT_SELF 0x4000
#define SHADOW_ONCE 0x8000
#define MATERIAL_UNLIT 8
