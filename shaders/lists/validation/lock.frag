// Every fragment of a square of SIDE pixels, once in the section of LOCK_INDEX (an expression of `id`, the pixel's
// number, `layer` and SIDE).
#include "shaders/lists/validation/lock.glsl"

flat in uint layer;

void main() {
  uint id = uint(gl_FragCoord.y) * SIDE + uint(gl_FragCoord.x);
  lockOnce(LOCK_INDEX, id + layer * SIDE * SIDE);
}
