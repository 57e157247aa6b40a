// Triangles whose corners are given as they are clipped.
#include "shaders/shared/bindings.h"

layout(std430, binding = STORAGE_COUNTERS) readonly buffer Corners {
  vec4 corners[];
};

void main() {
  gl_Position = corners[gl_VertexID];
}
