// Pushes every fragment of a layered framebuffer, by the layer that it was drawn into.
#include "shaders/lists/validation/list.glsl"

flat in uint target;

void main() {
  push((uint(gl_Layer) * HEIGHT + uint(gl_FragCoord.y)) * WIDTH + uint(gl_FragCoord.x) + 0u * target);
}
