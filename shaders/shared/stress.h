// The loads of `sfumato stress`: see lists/stress/load.h.
#pragma once
#include "shaders/shared/glsl.h"
SHARED_BEGIN

struct StressParams {
  ivec4 load;    // x, y: the grid of cells; z: seed; w: distribution
  ivec4 window;  // x: first cell that is built; y: cells; z: nodes that are dispatched; w: first of STORAGE_STRESS_NUMBERS
  vec4 lookups;  // x: depth of the last one
};

SHARED_END

// Values of STRESS_NODES, which C++ defines for lists/stress/insert.comp: the nodes of a load that are dispatched.
#define STRESS_ALL 0
#define STRESS_LAYERS 1   // layer after layer of the window's cells
#define STRESS_NUMBERS 2  // those whose numbers stand in STORAGE_STRESS_NUMBERS
