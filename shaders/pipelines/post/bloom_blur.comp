// One direction of a Gaussian blur.
#include "shaders/pipelines/post/post.glsl"

void main() {
  ivec2 pixel = pixelHere();
  if (!isInside(pixel, params.sizes.zw)) return;
  vec3 sum = vec3(0.0);
  float weights = 0.0;
  for (int i = -BLOOM_BLUR_RADIUS; i <= BLOOM_BLUR_RADIUS; ++i) {
    float weight = exp(-0.5 * float(i * i) / (BLOOM_BLUR_SIGMA * BLOOM_BLUR_SIGMA));
    sum += weight * lightAt(pixel + i * params.step.yz);
    weights += weight;
  }
  imageStore(result, pixel, vec4(sum / weights, 1.0));
}
