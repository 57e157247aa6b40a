// Light that smoke scatters more than once, by octaves (after Wrenninge, Kulla and Lundqvist 2013, "Oz: the great and
// volumetric"). SCATTER_OCTAVES, if defined, says how many. Octave i stands for light that was scattered about i times on its
// way to a point: it meets OCTAVE_DEPTH^i of the optical depth from its light, so that T^(OCTAVE_DEPTH^i) of it gets there,
// and the phase function has OCTAVE_PHASE^i of the medium's g. An octave adds only what the smoke took from the one before,
// T^(OCTAVE_DEPTH^i) - T^(OCTAVE_DEPTH^(i-1)), of which (OCTAVE_KEPT albedo)^i is left. So all of them together are never
// more than the light would be without smoke, and what is opaque stays dark.
#include "shaders/volumes/media.glsl"

// Of light of which `passing` gets to a point straight, what medium v turns by an angle, over the share of it that scatters.
vec3 turnedByMedium(int v, float cosine, vec3 passing) {
  float g = volumes[v].phase.x;
  vec3 sum = passing * phaseHenyeyGreenstein(cosine, g);
#ifdef SCATTER_OCTAVES
  vec3 kept = vec3(1.0);
  for (int i = 0; i < SCATTER_OCTAVES; ++i) {
    vec3 before = passing;
    passing = pow(passing, vec3(OCTAVE_DEPTH));
    kept *= OCTAVE_KEPT * volumes[v].albedo.rgb;
    g *= OCTAVE_PHASE;
    sum += kept * (passing - before) * phaseHenyeyGreenstein(cosine, g);
  }
#endif
  return sum;
}
