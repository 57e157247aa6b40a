// Media, as volumes/volumes_gpu uploads them.
#pragma once
#include "shaders/shared/glsl.h"
SHARED_BEGIN

struct VolumeData {
  mat4 textureFromWorld;  // texture coordinates of the density
  vec4 boxMin;            // of what may be denser than 0, in texture coordinates
  vec4 boxMax;
  vec4 albedoScale;       // rgb: albedo; w: sigma_t per unit of density, 1/m
  vec4 phase;             // x: Henyey-Greenstein g; y: shortest step between voxels, m
};

SHARED_END
