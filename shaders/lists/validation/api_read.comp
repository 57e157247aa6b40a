// Says what it finds in a buffer that it reads as READ_…: a uniform block, a buffer texture, a texture that was filled from
// it, a storage block; or how many workgroups it was started with.
layout(local_size_x = 64) in;

layout(std430, binding = 2) buffer Found {
  uint found[];
};

#if defined(READ_UNIFORM)
layout(std140, binding = 0) uniform Words {
  uvec4 words[16];
};
#elif defined(READ_BUFFER_TEXTURE)
layout(binding = 0) uniform usamplerBuffer words;
#elif defined(READ_TEXTURE)
layout(binding = 0) uniform usampler2D words;
#elif defined(READ_STORAGE)
layout(std430, binding = 1) readonly buffer Words {
  uint words[];
};
#endif

void main() {
  uint i = gl_LocalInvocationIndex;
#if defined(READ_UNIFORM)
  found[i] = words[i / 4u][i % 4u];
#elif defined(READ_BUFFER_TEXTURE)
  uvec3 texel = texelFetch(words, int(i / 3u)).rgb;
  found[i] = i == 63u ? 0u : i % 3u == 0u ? texel.r : i % 3u == 1u ? texel.g : texel.b;
#elif defined(READ_TEXTURE)
  found[i] = texelFetch(words, ivec2(i, 0), 0).r;
#elif defined(READ_STORAGE)
  found[i] = words[i];
#else
  if (i == 0u) atomicAdd(found[0], 1u);
#endif
}
