// The loads of `sfumato stress`: see lists/stress/load.h.
#pragma once
#include "shaders/shared/glsl.h"
SHARED_BEGIN

struct StressParams {
  ivec4 load;    // x, y: the grid of cells; z: seed; w: distribution
  ivec4 window;  // x: first cell that is built; y: cells; z: nodes that are dispatched; w: whether only its layers are
};

SHARED_END
