// Which pixels are walked sample by sample: see shaders/shared/resolve.h.
#include "shaders/shared/bindings.h"

layout(std430, binding = STORAGE_PIXEL_GROUPS) readonly buffer Groups {
  uint pixelGroups[];
};

// Of a pixel of the window.
bool isSplit(uint pixel) {
#if SAMPLES > 1
  return pixelGroups[pixel] != 0u;
#else
  return false;
#endif
}
