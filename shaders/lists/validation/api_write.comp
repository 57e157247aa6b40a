// Writes what is wanted to a buffer that is then read in another way than as a storage block.
layout(local_size_x = 64) in;

layout(std430, binding = 0) readonly buffer Wanted {
  uint wanted[];
};
layout(std430, binding = 1) writeonly buffer Written {
  uint written[];
};

void main() {
#if !defined(MUTANT_NO_WRITE) && !defined(WITHOUT_WRITE)
  written[gl_LocalInvocationIndex] = wanted[gl_LocalInvocationIndex];
#endif
}
