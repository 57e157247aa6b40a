// Whether a fragment of a rectangle about a triangle (scene/covering.glsl) is in the triangle.
flat in ivec4 coveringAB;
flat in ivec2 coveringC;

// Or on the line, where it is one that takes its points: points on a line that two triangles share are in one of them.
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
  return isLeftOf(coveringAB.xy, coveringAB.zw, centre) && isLeftOf(coveringAB.zw, coveringC, centre) &&
         isLeftOf(coveringC, coveringAB.xy, centre);
}
