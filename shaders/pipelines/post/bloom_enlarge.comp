// Adds a smaller image, enlarged by bilinear interpolation.
#include "shaders/pipelines/post/post.glsl"

void main() {
  ivec2 pixel = pixelHere();
  if (!isInside(pixel, params.sizes.zw)) return;
  vec2 place = (vec2(pixel) + 0.5) / float(params.step.x) - 0.5;
  ivec2 first = ivec2(floor(place));
  vec2 f = place - vec2(first);
  vec3 above = mix(lightAt(first), lightAt(first + ivec2(1, 0)), f.x);
  vec3 below = mix(lightAt(first + ivec2(0, 1)), lightAt(first + ivec2(1, 1)), f.x);
  vec4 old = imageLoad(result, pixel);
  imageStore(result, pixel, vec4(old.rgb + params.light.z * mix(above, below, f.y), old.a));
}
