#include "shaders/lists/validation/long_loop.glsl"

void main() {
  uint id = uint(gl_FragCoord.y) * SIDE + uint(gl_FragCoord.x);
  counts[id] = iterations(id);
}
