// A smaller image: every texel spreads its light over the four nearest ones of the smaller image, as bilinear
// interpolation would read it from there. So light is neither lost nor moved, wherever a lamp stands in the grid.
// BRIGHT: only what glows is taken, 1: by contrast, 2: by threshold.
#include "shaders/pipelines/post/post.glsl"

vec3 glowing(vec3 radiance) {
#if BRIGHT == 1
  return radiance * min(luminance(radiance) / params.light.x, 1.0);
#elif BRIGHT == 2
  float y = luminance(radiance);
  return y > params.light.y ? radiance * ((y - params.light.y) / y) : vec3(0.0);
#else
  return radiance;
#endif
}

void main() {
  ivec2 pixel = pixelHere();
  if (!isInside(pixel, params.sizes.zw)) return;
  int side = params.step.x;
  vec2 centre = (vec2(pixel) + 0.5) * float(side);
  ivec2 first = ivec2(ceil(centre - 0.5 - float(side)));
  vec3 sum = vec3(0.0);
  for (int y = 0; y < 2 * side; ++y)
    for (int x = 0; x < 2 * side; ++x) {
      ivec2 from = first + ivec2(x, y);
      vec2 weights = max(1.0 - abs(vec2(from) + 0.5 - centre) / float(side), 0.0);
      sum += weights.x * weights.y * glowing(lightAt(from));
    }
  imageStore(result, pixel, vec4(sum / float(side * side), 1.0));
}
