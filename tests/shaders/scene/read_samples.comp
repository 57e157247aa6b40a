// The samples of an image as a row of values.
#include "shaders/shared/bindings.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = TEXTURE_ROUTED_KEYS) uniform sampler2DMS image;
layout(std430, binding = STORAGE_COUNTERS) writeonly buffer Values {
  vec4 values[];
};

void main() {
  ivec2 size = textureSize(image);
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, size))) return;
  for (int i = 0; i < SAMPLES; ++i)
    values[(pixel.y * size.x + pixel.x) * SAMPLES + i] = texelFetch(image, pixel, i);
}
