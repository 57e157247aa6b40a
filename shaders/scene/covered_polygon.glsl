// Which pixels a triangle covers once it is clipped and its corners are rounded (scene/covering.glsl): those whose centres
// are in one of the triangles that Mesa's software drivers make of it, all of which begin with the first corner.

// The centre of pixel (x, y) is at (x, y) << SUBPIXEL_BITS. These drivers have 8 bits, whatever they answer to
// GL_SUBPIXEL_BITS; tests set others.
#ifndef SUBPIXEL_BITS
#define SUBPIXEL_BITS 8
#endif

// Counter-clockwise; who includes this defines them.
int cornerCount();
ivec2 corner(int i);

// Of a line, or on it, where it is one that takes its points: of two triangles that share it one does.
bool isLeftOf(ivec2 from, ivec2 to, ivec2 point) {
  dvec2 line = dvec2(to - from);
  dvec2 offset = dvec2(point - from);
  double side = line.x * offset.y - line.y * offset.x;  // exact
  bool takesPoints = line.y < 0.0 || (line.y == 0.0 && line.x > 0.0);
  return side > 0.0 || (side == 0.0 && takesPoints);
}

// `pixel`: of the whole image.
bool isCovered(ivec2 pixel) {
  ivec2 centre = pixel << SUBPIXEL_BITS;
  ivec2 a = corner(0);
  ivec2 b = corner(1);
  bool covered = false;
  for (int i = 2; i < cornerCount(); ++i) {
    ivec2 c = corner(i);
    covered = covered || (isLeftOf(a, b, centre) && isLeftOf(b, c, centre) && isLeftOf(c, a, centre));
    b = c;
  }
  return covered;
}
