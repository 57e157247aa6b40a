// Whether a fragment of a rectangle about a triangle (scene/covering.glsl) is in the triangle.
#include "shaders/scene/subpixels.glsl"

flat in ivec4 coveringCorners[5];
flat in int coveringCount;

ivec2 coveringCorner(int i) {
  ivec4 two = coveringCorners[i >> 1];
  return (i & 1) == 0 ? two.xy : two.zw;
}

// Of a line, or on it, where it is one that takes its points: of two triangles that share it one does.
bool isLeftOf(ivec2 from, ivec2 to, ivec2 point) {
  dvec2 line = dvec2(to - from);
  dvec2 offset = dvec2(point - from);
  double side = line.x * offset.y - line.y * offset.x;  // exact
  bool takesPoints = line.y < 0.0 || (line.y == 0.0 && line.x > 0.0);
  return side > 0.0 || (side == 0.0 && takesPoints);
}

// `pixel`: of the whole image. Asks the triangles that drivers make of a polygon.
bool isCovered(ivec2 pixel) {
  ivec2 centre = pixel << SUBPIXEL_BITS;
  ivec2 a = coveringCorner(0);
  ivec2 b = coveringCorner(1);
  bool covered = false;
  for (int i = 2; i < coveringCount; ++i) {
    ivec2 c = coveringCorner(i);
    covered = covered || (isLeftOf(a, b, centre) && isLeftOf(b, c, centre) && isLeftOf(c, a, centre));
    b = c;
  }
  return covered;
}

// From the first corner to a pixel's centre.
vec2 coveringOffset(ivec2 pixel) {
  return vec2((pixel << SUBPIXEL_BITS) - coveringCorners[0].xy) / float(1 << SUBPIXEL_BITS);
}
