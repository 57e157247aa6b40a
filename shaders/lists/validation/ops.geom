#include "shaders/lists/validation/ops.glsl"

layout(points) in;
layout(points, max_vertices = 1) out;
flat in uint pointId[];

void main() {
  runOperations(pointId[0]);
}
