// Every fragment of validation::drawPatches, once in the section of LOCK_INDEX (an expression of `id`, the pixel's number, of its
// place `pixel` in the patch, and of PATCH).
#include "shaders/lists/validation/lock.glsl"
#include "shaders/lists/validation/patches.glsl"

void main() {
  if (!inPatch()) return;
  uint id = patchId();
  uvec2 pixel = patchPixel();
  if (layer == 0u && pixel % 8u == uvec2(0u)) gate();
  lockOnce(LOCK_INDEX, id + layer * GRID * GRID * PATCH * PATCH);
}
