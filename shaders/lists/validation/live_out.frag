#include "shaders/lists/validation/live_out.glsl"

void main() {
  uint id = uint(gl_FragCoord.y) * SIDE + uint(gl_FragCoord.x);
  values[id] = liveOut(id);
}
