// The numbers of the last fragments that are kept in samples: those of later pages come after them. params.options.x is the
// layer that is full where there are any.
#include "shaders/shared/bindings.h"
#include "shaders/shared/resolve_block.glsl"

#if ROUTED_SAMPLES > 1
layout(binding = TEXTURE_ROUTED_KEYS) uniform usampler2DMSArray keys;
#else
layout(binding = TEXTURE_ROUTED_KEYS) uniform usampler2DArray keys;
#endif
layout(location = 0) out uint last;

void main() {
  last = texelFetch(keys, ivec3(ivec2(gl_FragCoord.xy), params.options.x), ROUTED_SAMPLES - 1).y;
}
