// Values that are made in a loop which the lanes of a vector leave at different times, and are used after it.
// FORM: which way the value takes.
#include "shaders/shared/hash.glsl"

#define FORM_LOADED 0       // loaded in the body of the loop
#define FORM_COPIED 1       // the same, through another variable
#define FORM_ATOMIC 2       // what an atomic operation returned
#define FORM_COMPUTED 3     // computed from the value of the iteration before
#define FORM_CONDITIONAL 4  // loaded, and kept by a condition in a variable from before the loop
#define FORM_WALK 5         // the node before the end of a list, as in sorted insertion

layout(std430, binding = 0) coherent buffer Table {
  uint table[];  // as a list: table[i] is the node after node i
};
layout(std430, binding = 1) writeonly buffer Values {
  uint values[];
};

const uint MOST = 64u;

// Iterations of lane `id`: 1 to MOST.
uint iterations(uint id) {
  return 1u + hash(id + SEED) % MOST;
}

uint liveOut(uint id) {
  uint n = iterations(id);
  uint i = 0u;
#if FORM == FORM_LOADED
  uint value;
  do {
    value = table[i];
    ++i;
  } while (i < n);
  return value;
#elif FORM == FORM_COPIED
  uint value = 0u;
  do {
    uint loaded = table[i];
    value = loaded;
    ++i;
  } while (i < n);
  return value;
#elif FORM == FORM_ATOMIC
  uint value = 0u;
  do {
    value = atomicCompSwap(table[i], 0xffffffffu, id);
    ++i;
  } while (i < n);
  return value;
#elif FORM == FORM_COMPUTED
  uint value = id;
  do {
    value = value * 1664525u + 1013904223u;
    ++i;
  } while (i < n);
  return value;
#elif FORM == FORM_CONDITIONAL
  uint value = 0u;
  bool done = false;
  while (!done && i < MOST) {
    uint loaded = table[i];
    ++i;
#ifdef MUTANT_NO_CONDITION
    value = loaded;
    if (i >= MOST) done = true;
#else
    if (i >= n) {
      value = loaded;
      done = true;
    }
#endif
  }
  return value;
#else
  uint previous = 0u;
  uint current = 1u;
  while (current != 0u && i < n) {
    previous = current;
    current = table[current];
    ++i;
  }
  return previous;
#endif
}
