#include "shaders/lists/validation/leave_loop.glsl"

void main() {
  uint id = uint(gl_FragCoord.y) * SIDE + uint(gl_FragCoord.x);
  sums[id] = walk(id);
}
