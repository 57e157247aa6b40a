#include "shaders/lists/validation/traverse.glsl"

void main() {
  traverse(uint(gl_FragCoord.y) * WIDTH + uint(gl_FragCoord.x));
}
