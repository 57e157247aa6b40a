// A knot of the smoke's part of a texel's function.
#include "shaders/volumes/extinction.glsl"

struct SmokeKnot {
  float depth;
  Extinction tau;  // optical depth from the light to here
};
