// Copies the opaque depth of a face beside its texels' runs, where a lookup finds both with one read.
#include "shaders/shared/bindings.h"
#include "shaders/shared/deepshadow.h"
#include "shaders/shared/view.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(std140, binding = UNIFORM_VIEW) uniform View {
  ViewParams view;
};
layout(std140, binding = UNIFORM_PASS) uniform Pass {
  ShadowPassParams params;
};
layout(std430, binding = STORAGE_SHADOW_TEXELS) writeonly buffer Texels {
  ShadowTexel texels[];
};
layout(binding = TEXTURE_OPAQUE_DEPTH) uniform sampler2D opaqueDepth;

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (texel.x >= view.size.x || texel.y >= view.size.y) return;
  int number = params.range.x + view.size.z + texel.y * view.size.x + texel.x;
  texels[number].opaqueDepth = texelFetch(opaqueDepth, texel, 0).r;
}
