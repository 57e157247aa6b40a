// Pushes a primitive: point `pointId`. Nothing is drawn.
#include "shaders/lists/validation/list.glsl"

layout(points) in;
layout(points, max_vertices = 1) out;
flat in uint pointId[];

void main() {
  push(pointId[0]);
}
