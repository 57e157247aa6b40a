// Moves one coin from an account to another under both their locks, taken in the order of their numbers; who gets only
// the first gives it back, so that no invocation waits while it holds a lock.
#include "shaders/lists/validation/lock.glsl"
#include "shaders/shared/linear_id.glsl"

void main() {
  uint id = linearId();
  if (gl_LocalInvocationIndex == 0u) gate();
  if (id >= COUNT) return;
  uint from = hash(id) % LOCKS;
  uint to = (from + 1u + hash(id + COUNT) % (LOCKS - 1u)) % LOCKS;
  uint first = min(from, to);
  uint second = max(from, to);
  bool done = false;
  uint spins = 0u;
  uint limit = spinLimit();
  while (!done && spins < limit) {
    ++spins;
    uint head;
    if (acquire(first, head)) {
#ifdef MUTANT_ONE_LOCK
      guarded[from] -= 1u;
      guarded[to] += 1u;
      done = true;
#else
      uint other;
      if (acquire(second, other)) {
        guarded[from] -= 1u;
        guarded[to] += 1u;
        release(second, other);
        done = true;
      }
#endif
      release(first, head);
    }
  }
  count(done, spins);
}
