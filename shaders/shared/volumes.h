// Media, as volumes/volumes_gpu uploads them.
#pragma once
#include "shaders/shared/glsl.h"
SHARED_BEGIN

// The density of medium v is grid v: see grids.h.
struct VolumeData {
  vec4 albedoScale;  // rgb: albedo; w: sigma_t per unit of density, 1/m
  vec4 phase;        // x: Henyey-Greenstein g; y: shortest step between voxels, m
};

SHARED_END
