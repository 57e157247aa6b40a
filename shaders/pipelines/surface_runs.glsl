// The camera's lists of surfaces, for readers.
#include "shaders/lists/runs.glsl"
#include "shaders/shared/surface.h"

PackedSurface listedSurface(uint node) {
  uvec2 a = listPayloadPair(5u * node);
  uvec2 b = listPayloadPair(5u * node + 1u);
  uvec2 c = listPayloadPair(5u * node + 2u);
  uvec2 d = listPayloadPair(5u * node + 3u);
  uvec2 e = listPayloadPair(5u * node + 4u);
  return PackedSurface(a.x, a.y, b.x, b.y, c.x, c.y, d.x, d.y, e.x, e.y);
}

// Its samples that are covered, and its object.
uint listedCoverageObject(uint node) {
  return listPayloadPair(5u * node + 4u).y;
}
