#include "shaders/lists/validation/float_sum.glsl"

void main() {
  addToSum(uint(gl_FragCoord.y) * SIDE + uint(gl_FragCoord.x));
}
