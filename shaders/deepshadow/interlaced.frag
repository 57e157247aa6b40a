// The nearest surface of each texel of a light's shadow map (Aladagli 2015, section 3.2.1). A line above or below one that
// shows a translucent surface, which only odd ones do, shows the opaque one behind it.
#include "shaders/deepshadow/way_through.glsl"
#include "shaders/shared/deepshadow.h"

layout(location = 0) out float depth;     // from the light; below 0: of a translucent surface
#ifdef TRANSLUCENT
layout(location = 1) out vec4 letThrough;  // by that; of it 1 - alpha: see interlaced_maps_gpu.h
#endif
#ifdef THESIS_FILTER
layout(std140, binding = UNIFORM_PASS) uniform Pass {
  InterlacedPassParams params;
};
#endif

void main() {
  vec4 base = baseColour();
  float tau = transmission();
  vec3 pass = passThrough(base, tau);
  if (base.a == 0.0 || pass == vec3(1.0)) discard;
  depth = fragmentDepth();
  gl_FragDepth = 1.0 / (1.0 + depth);  // as exact as a float, near and far
#ifdef TRANSLUCENT
  bool translucent = pass != vec3(0.0);
  if (translucent && (int(gl_FragCoord.y) & 1) == 0) discard;
  if (translucent) depth = -depth;
#ifdef THESIS_FILTER
  vec3 colour = params.lightColour.rgb;
  letThrough = vec4(min(colour, base.rgb) / max(colour, 1e-20), base.a * (1.0 - tau));
#else
  float way = wayThrough();
  letThrough = vec4(way == 1.0 ? pass : pow(pass, vec3(way)), 0.0);  // some drivers' pow(x, 1) is not x
#endif
#endif
}
