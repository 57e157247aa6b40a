// Pushes every fragment of a rectangle of WIDTH x HEIGHT pixels, layer by layer; per sample where SAMPLES is more than 1.
#include "shaders/lists/validation/list.glsl"

flat in uint layer;

void main() {
  uint item = (layer * HEIGHT + uint(gl_FragCoord.y)) * WIDTH + uint(gl_FragCoord.x);
#if SAMPLES > 1
  item = item * uint(SAMPLES) + uint(gl_SampleID);
#endif
  push(item);
}
