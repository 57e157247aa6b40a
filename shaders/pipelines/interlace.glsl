// Which pixels of an interlaced image may hold translucent surfaces (Aladagli 2015, section 3.1.1). INTERLACE is
// INTERLACE_LINES: every other line; or INTERLACE_CHECKERBOARD.
#include "shaders/shared/layers.h"

bool maybeTranslucent(ivec2 pixel) {
#if INTERLACE == INTERLACE_CHECKERBOARD
  return ((pixel.x + pixel.y) & 1) != 0;
#else
  return (pixel.y & 1) != 0;
#endif
}
