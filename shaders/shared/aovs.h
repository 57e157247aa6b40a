// What is told of a pixel beside its radiance: see pipelines/aovs.h.
#pragma once
#include "shaders/shared/glsl.h"
SHARED_BEGIN

struct AovPixel {
  float depth;  // 3e38: nothing opaque
  float normalX;
  float normalY;
  float normalZ;
  float albedoR;
  float albedoG;
  float albedoB;
  uint lights;
  uint fragments;
  uint shadowNodes;
};

SHARED_END
