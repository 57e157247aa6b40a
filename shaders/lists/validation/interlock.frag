// Fragments of one pixel go through an interlocked section: each notes the layer of the one before it, and its own.
#extension GL_ARB_fragment_shader_interlock : require

#if defined(MUTANT_NO_INTERLOCK) && !defined(WITHOUT_INTERLOCK)
#define WITHOUT_INTERLOCK
#endif

layout(MODE) in;
#include "shaders/lists/validation/patches.glsl"

layout(std430, binding = 0) coherent buffer Pixels {
  uvec2 pixels[];  // fragments so far, layer of the last one + 1
};
layout(std430, binding = 1) coherent buffer Outcome {
  uint disorder;  // fragments that did not follow the layer before theirs
};

void main() {
  uint pixel = patchId();
  bool inOrder;
#ifndef WITHOUT_INTERLOCK
  beginInvocationInterlockARB();
#endif
  uvec2 before = pixels[pixel];
  inOrder = before.y == layer;
  pixels[pixel] = uvec2(before.x + 1u, layer + 1u);
#ifndef WITHOUT_INTERLOCK
  endInvocationInterlockARB();
#endif
  if (!inOrder) atomicAdd(disorder, 1u);
}
