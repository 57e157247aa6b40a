// Long work of every fragment of a square of 64 pixels, and its result.
layout(std430, binding = 0) writeonly buffer Told {
  uint told[];
};
layout(std430, binding = 1) readonly buffer Round {
  uint round;
};

void main() {
  uint at = uint(gl_FragCoord.y) * 64u + uint(gl_FragCoord.x);
  uint x = at + round;
  for (uint i = 0u; i < WORK; ++i) x = x * 1664525u + 1013904223u;
  told[at] = x;
}
