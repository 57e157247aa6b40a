// Invocation WAITER of all waits, within bounds, for a flag that invocation SETTER sets. They are lane 0 of different
// workgroups, or lanes of one: GROUP_SIZE lanes a workgroup.
layout(local_size_x = GROUP_SIZE) in;

layout(std430, binding = 0) coherent buffer Outcome {
  uint flag;
  uint seen;   // 1: the waiter saw the flag
  uint polls;  // it took so many looks
};

void main() {
  if (gl_GlobalInvocationID.x == WAITER) {
    uint looks = 0u;
    uint found = 0u;
    while (found == 0u && looks < POLL_LIMIT) {
      ++looks;
      found = atomicAdd(flag, 0u);
    }
    seen = found;
    polls = looks;
  } else if (gl_GlobalInvocationID.x == SETTER) {
#ifndef MUTANT_NO_FLAG
    atomicExchange(flag, 1u);
#endif
  }
}
