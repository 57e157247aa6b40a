// Runs and counters of the lists that are built.
#include "shaders/shared/bindings.h"
#include "shaders/shared/lists.h"

layout(std430, binding = STORAGE_LIST_RUNS) coherent buffer ListRuns {
  ListRun listRuns[];
};
layout(std430, binding = STORAGE_LIST_COUNTERS) coherent buffer ListCounting {
  ListCounters listCounters;
  uint listTallies[LIST_TALLIES];
};
layout(std140, binding = UNIFORM_LISTS) uniform ListWindows {
  ListWindow listWindow;
};
