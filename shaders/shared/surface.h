// A lit surface point, packed: two G-buffer textures hold the first eight words, with the object in place of what an
// opaque surface lets pass; a node of the camera's lists all of them.
#pragma once
#include "shaders/shared/glsl.h"
SHARED_BEGIN

// Halves are pairs from packHalf2x16, normals octahedral from packSnorm2x16.
struct PackedSurface {
  uint normal;             // shading normal
  uint geometricNormal;    // of the triangle's plane; both turned towards the viewer
  uint diffuseRg;          // what is reflected diffusely: b (1 - metallic) a (1 - tau)
  uint diffuseBRoughness;
  uint f0Rg;               // specular reflectance at normal incidence, times alpha
  uint f0BF90;
  uint emissiveRg;
  uint emissiveBPassR;     // t = 1 - a (1 - tau b): what is let through
  uint passGb;
  uint coverageObject;     // bits 0 to 3: bit n: sample n of the pixel is covered; 4 to 15: 1 - alpha, in 4095ths; high:
                           // SHADOW_* if it does not shadow itself
};

SHARED_END
