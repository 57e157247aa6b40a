// Whether a fragment of a rectangle about a triangle (scene/covering.glsl) is in the triangle: isCovered().
#include "shaders/scene/covered_polygon.glsl"

flat in ivec4 coveringCorners[5];
flat in int coveringCount;

int cornerCount() {
  return coveringCount;
}

ivec2 corner(int i) {
  ivec4 two = coveringCorners[i >> 1];
  return (i & 1) == 0 ? two.xy : two.zw;
}

// From the first corner to a pixel's centre, in pixels.
vec2 coveringOffset(ivec2 pixel) {
  return vec2((pixel << SUBPIXEL_BITS) - corner(0)) / float(1 << SUBPIXEL_BITS);
}
