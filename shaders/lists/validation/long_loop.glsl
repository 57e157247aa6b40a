// Loops that are long: how many iterations does one invocation get? OUTER x INNER of them are asked for; in a walk each
// is a step along a list, in a march a step along a ray.
layout(std430, binding = 0) readonly buffer Links {
  uint links[];
};
layout(std430, binding = 1) writeonly buffer Counts {
  uint counts[];
};

uint iterations(uint id) {
  uint done = 0u;
#if defined(WALK)
  uint node = 1u;
  while (node != 0u && done < OUTER * INNER) {
    node = links[node];
    ++done;
  }
#elif defined(MARCH)
  float t = 0.0;
  for (uint i = 0u; i < OUTER * INNER && t < 1e9; ++i) {
    t += 1.0 + 0.25 * float(id & 3u);
    ++done;
  }
#else
  for (uint i = 0u; i < OUTER; ++i)
    for (uint j = 0u; j < INNER; ++j) {
      done += 1u + (id >> 31);
    }
#endif
#ifdef MUTANT_CUT
  done = min(done, 1000u);
#endif
  return done;
}
