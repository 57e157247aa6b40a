// Media, as volumes/volumes_gpu uploads them.
#pragma once
#include "shaders/shared/glsl.h"
SHARED_BEGIN

// The density of medium v is grid v (see grids.h). Behind the media come the fires, whose grids are those behind the
// densities: they have a ramp and the length of a step, and take and scatter nothing.
struct VolumeData {
  vec4 extinction;  // rgb: its colour, the largest 1; w: sigma_t per unit of density where the colour is 1, 1/m
  vec4 albedo;      // rgb
  vec4 scattering;  // rgb: albedo times the extinction's colour
  vec4 ramp;        // of a fire, x: entries of its ramp for one unit of its value, y: number of the first, z: of the last
  vec4 phase;       // x: Henyey-Greenstein g; y: shortest step between voxels, m
};

SHARED_END

// Of each octave of multiple scattering, to the one before: optical depth, phase function's g, light that is left. Octaves
// of these never scatter more in all than a slab does (docs/how_it_works.md, "The medium").
#define OCTAVE_DEPTH 0.5
#define OCTAVE_PHASE 0.5
#define OCTAVE_KEPT 0.7
