// What a camera's ray meets, recorded for a deep image.
#pragma once
#include "shaders/shared/glsl.h"
SHARED_BEGIN

// A surface, or a step through smoke. Those of a ray stand in order of depth.
struct DeepEvent {
  uint ray;      // its number in DeepRays
  float front;   // depth
  float back;    // front for a surface
  float addedR;  // radiance, as it gets to the camera
  float addedG;
  float addedB;
  float throughputR;  // of the ray behind it
  float throughputG;
  float throughputB;
};

SHARED_END
