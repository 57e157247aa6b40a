// A cell that a light's proxy covers. Only the far side of the proxy counts: it covers every cell once, also with the
// camera inside the light.
#include "shaders/lights/cell_light.glsl"

flat in uint vLight;

void main() {
  if (!gl_FrontFacing) enterLight(vLight, ivec2(gl_FragCoord.xy));
}
