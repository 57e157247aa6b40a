// What a light adds to a layer's surfaces. TABLE_STORAGE: see layer.glsl; FINISHED: radiance all the same.
#include "shaders/pipelines/camera_ray.glsl"
#include "shaders/pipelines/layer.glsl"
#include "shaders/pipelines/surface_lighting.glsl"

layout(location = 0) out vec4 light;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float depth = layerDepth(pixel);
  if (depth >= view.depthRange.y) discard;
  PixelRay ray = pixelRay(imagePlane(view, vec2(pixel) + 0.5), 1.0);
  vec3 p = ray.origin + depth * ray.perDepth;
  Surface surface = unpackSurface(layerSurface(pixel));
  uint number = uint(params.options.w);
#if defined(TABLE_STORAGE) && !defined(FINISHED)
  vec3 toLight;
  vec3 received = receivedFrom(number, surface, p, toLight);
  vec3 mirrored;
  float scattered = brdfParts(surface, toLight, ray.towardsViewer, mirrored);
  light = vec4(received * scattered, maxComponent(received * mirrored));
#else
  light = vec4(reflectedFrom(number, surface, p, ray.towardsViewer), 0.0);
#endif
}
