// Stores an item for each fragment of a square of SIDE pixels, layer by layer.
#include "shaders/lists/validation/engine.glsl"

flat in uint layer;

void main() {
  storeItem((layer * SIDE + uint(gl_FragCoord.y)) * SIDE + uint(gl_FragCoord.x));
}
