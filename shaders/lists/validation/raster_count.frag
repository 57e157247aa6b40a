// Counts the fragments of each pixel of a square of SIDE. EARLY: depth is tested before the shader runs.
#if defined(EARLY) && !defined(MUTANT_NO_EARLY)
layout(early_fragment_tests) in;
#endif

layout(std430, binding = 0) coherent buffer Counts {
  uint counts[];
};
#ifdef COLOUR
layout(location = 0) out vec4 colour;
#endif

void main() {
#ifndef MUTANT_NO_COUNT
  atomicAdd(counts[uint(gl_FragCoord.y) * SIDE + uint(gl_FragCoord.x)], 1u);
#endif
#ifdef COLOUR
  colour = vec4(1.0);
#endif
}
