// What the passes of post-processing share: one invocation for each pixel that is written.
#include "shaders/shared/bindings.h"
#include "shaders/shared/post.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(std140, binding = UNIFORM_PASS) uniform Pass {
  PostParams params;
};
layout(binding = TEXTURE_PICTURE) uniform sampler2D picture;
layout(rgba32f, binding = IMAGE_PICTURE) uniform image2D result;

float luminance(vec3 radiance) {
  return dot(radiance, vec3(0.2126, 0.7152, 0.0722));
}

ivec2 pixelHere() {
  return ivec2(gl_GlobalInvocationID.xy);
}

bool isInside(ivec2 pixel, ivec2 size) {
  return all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, size));
}

// Beside the image it is dark: no light comes from what nobody has seen.
vec3 lightAt(ivec2 pixel) {
  return isInside(pixel, params.sizes.xy) ? texelFetch(picture, pixel, 0).rgb : vec3(0.0);
}
