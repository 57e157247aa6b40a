// Depth of opaque surfaces from a light; blending keeps the smallest, so the depth is exact at any distance.
#include "shaders/scene/material.glsl"

layout(location = 0) out float depth;

void main() {
  if (isCutOut()) discard;
  depth = fragmentDepth();
}
