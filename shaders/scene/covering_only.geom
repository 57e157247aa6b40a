// Rectangles of pixels in place of triangles that have nothing to be interpolated: scene/covering.glsl.
#include "shaders/scene/covering.glsl"

void interpolate(dmat3 weights) {}
