// Walks the list of a pixel and says how many of its items are right. Bound and cycle-proof.
#include "shaders/shared/hash.glsl"

layout(std430, binding = 0) readonly buffer Links {
  uint links[];
};
layout(std430, binding = 1) readonly buffer Items {
  uint items[];
};
layout(std430, binding = 3) coherent buffer Walks {
  uint wrongPixels;  // whose list does not hold each of its LAYERS items once
  uint walkedPixels;
  uint boundHits;
};

void traverse(uint pixel) {
  uint node = links[pixel];
  uint layersSeen = 0u;
  uint length = 0u;
  bool stray = false;
  while (node != 0u && length <= LAYERS) {
    uint item = items[node];
    if (item % HEADS != pixel || item / HEADS >= LAYERS) stray = true;
    layersSeen |= 1u << ((item / HEADS) % 32u);
    ++length;
    node = links[HEADS + node];
  }
  if (length > LAYERS) atomicAdd(boundHits, 1u);
  if (stray || length != LAYERS || layersSeen != (1u << LAYERS) - 1u) atomicAdd(wrongPixels, 1u);
  atomicAdd(walkedPixels, 1u);
}
