// A surface as a forward renderer lights it (Aladagli 2015, section 4.1.3): first what it gives by itself, with depth, normal
// and what it lets through; then, with LIGHT defined, what one light adds. TRANSLUCENT, INTERLACE: see layer.frag.
#include "shaders/pipelines/brdf.glsl"
#include "shaders/pipelines/camera_ray.glsl"
#include "shaders/pipelines/layer_ambient.glsl"
#include "shaders/scene/surface.glsl"
#ifdef LIGHT
#include "shaders/pipelines/surface_lighting.glsl"
#endif
#ifdef INTERLACE
#include "shaders/pipelines/interlace.glsl"
#endif

layout(location = 0) out vec4 light;
#ifndef LIGHT
layout(location = 1) out vec4 pass;
layout(location = 2) out vec4 normal;
layout(location = 3) out float depth;
#endif

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float at = fragmentDepth();
  PackedSurface stored = packSurface(baseColour());  // derivatives are taken before the flow diverges
  bool wanted = baseColour().a > 0.0;
#ifdef INTERLACE
  wanted = wanted && maybeTranslucent(pixel);
#endif
  if (!wanted) discard;
  Surface surface = unpackSurface(stored);
#ifdef LIGHT
  PixelRay ray = pixelRay(imagePlane(view, vec2(pixel) + 0.5), 1.0);
  vec3 p = ray.origin + at * ray.perDepth;
  light = vec4(reflectedFrom(uint(params.options.w), surface, p, ray.towardsViewer), 0.0);
#else
#ifdef TRANSLUCENT
  pass = vec4(surfacePass(stored), 1.0);
#else
  pass = vec4(0.0);
#endif
  light = vec4(glow(surface, pixel, at, pass.a > 0.5), 0.0);
  normal = vec4(0.5 + 0.5 * surface.normal, 0.0);
  depth = at;
#endif
}
