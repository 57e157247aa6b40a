// The fragments of a patch are the partners of those of the next one, or (VERTICES) of vertices that are drawn meanwhile.
#include "shaders/lists/validation/litmus.glsl"
#include "shaders/lists/validation/patches.glsl"

void main() {
  if (!inPatch()) return;
#ifdef VERTICES
  litmus(1u, patchId());
#else
  uint pixels = PATCH * PATCH;
  uint id = patchId();
  uint square = id / pixels;
  litmus(square & 1u, square / 2u * pixels + id % pixels);
#endif
}
