// Meshes and materials, as scene/geometry_gpu uploads them.
#pragma once
#include "shaders/shared/glsl.h"
SHARED_BEGIN

// One instance of one mesh.
struct DrawData {
  mat4 worldFromObject;
  mat4 normalFromObject;  // inverse transpose, upper 3x3
  ivec4 indices;          // x: material, y: number of its first primitive among those of all draws
};

#define MATERIAL_TEXTURES 7  // units TEXTURE_BASE_COLOUR to TEXTURE_SPECULAR_COLOUR

struct MaterialData {
  vec4 baseColour;      // linear, alpha
  vec4 emissive;        // rgb; w: alpha cutoff
  vec4 specularColour;  // rgb; w: specular factor
  vec4 factors;         // metallic, roughness, normal scale, transmission
  ivec4 flags;          // x: MATERIAL_*, y: bit n: texture unit n reads the second uv set
  vec4 uvTransforms[2 * MATERIAL_TEXTURES];  // two rows for each unit: what stands to the left of (u, v, 1, 0)
};

SHARED_END

#define MATERIAL_MASK 1
#define MATERIAL_BLEND 2
#define MATERIAL_NORMAL_MAP 4
#define MATERIAL_UNLIT 8
