#include "shaders/lists/validation/ops.glsl"

void main() {
  runOperations(uint(gl_FragCoord.y) * 8u + uint(gl_FragCoord.x));
}
