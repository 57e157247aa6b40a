// Takes node numbers through a storage buffer, an exchange and an image, and stores words far behind word 2^24.
layout(local_size_x = 64) in;

layout(std430, binding = 0) readonly buffer Wanted {
  uint wanted[];
};
layout(std430, binding = 1) coherent buffer Found {
  uint found[];  // 64 that were exchanged, 64 from the image, 64 from far behind
};
layout(std430, binding = 2) coherent buffer Far {
  uint far[];
};
layout(r32ui, binding = 0) coherent uniform uimage2D image;

const uint FIRST = 1u << 24;

void main() {
  uint i = gl_LocalInvocationIndex;
  uint number = wanted[i];
  uint place = FIRST + i;
  atomicExchange(found[i], number);
  imageStore(image, ivec2(i, 0), uvec4(number));
  memoryBarrierImage();
  found[64u + i] = imageLoad(image, ivec2(i, 0)).r;
  far[place] = number;
}
