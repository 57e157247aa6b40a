// The loads of `sfumato stress`: see lists/stress/load.h.
#pragma once
#include "shaders/shared/glsl.h"
SHARED_BEGIN

struct StressParams {
  uint width;   // of the grid of cells
  uint height;
  uint nodes;
  uint seed;
};

SHARED_END
