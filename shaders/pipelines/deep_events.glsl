// What a ray meets on its walk, recorded where DEEP is defined; elsewhere all of this is nothing.
#include "shaders/shared/bindings.h"
#include "shaders/shared/deep.h"

#ifdef DEEP
// The rays that are walked, and how many events they made, counted past the capacity.
layout(std430, binding = STORAGE_DEEP_RAYS) buffer DeepRays {
  uint deepEventCount;
  uint deepRays[];
};
layout(std430, binding = STORAGE_DEEP_EVENTS) writeonly buffer DeepEvents {
  DeepEvent deepEvents[];
};

uint deepRay = 0u;  // the number of this one in deepRays

// The ray of an invocation.
uint rayNumber(uint invocation) {
  deepRay = invocation;
  return deepRays[invocation];
}

// Events of one ray take ascending places, as one invocation makes them one after the other.
void recordEvent(float front, float back, vec3 added, vec3 throughput) {
  uint place = atomicAdd(deepEventCount, 1u);
  if (place < uint(deepEvents.length()))
    deepEvents[place] = DeepEvent(deepRay, front, back, added.r, added.g, added.b, throughput.r, throughput.g, throughput.b);
}
#else
#ifdef PASSING_RAYS
layout(std430, binding = STORAGE_WALKED_RAYS) readonly buffer WalkedRays {
  uint walkedRays[];
};

uint rayNumber(uint invocation) {
  return walkedRays[invocation];
}
#else
uint rayNumber(uint invocation) {
  return invocation;
}
#endif

void recordEvent(float front, float back, vec3 added, vec3 throughput) {}
#endif
