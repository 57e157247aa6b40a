// Depths alone, of what the surfaces do not cut out.
#include "shaders/scene/material.glsl"

void main() {
  if (isCutOut()) discard;
}
