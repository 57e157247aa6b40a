// The form that list code must not have: the lock is waited for before its section. Bounded, and who gives up does not
// enter.
#include "shaders/lists/validation/lock.glsl"
#include "shaders/shared/linear_id.glsl"

void main() {
  uint id = linearId();
  if (gl_LocalInvocationIndex == 0u) gate();
  if (id >= COUNT) return;
  uint lock = LOCK_INDEX;
  uint head;
  bool got = false;
  uint spins = 0u;
  uint limit = spinLimit();
  while (!got && spins < limit) {
    ++spins;
    got = acquire(lock, head);
  }
  if (got) {
    section(lock, id);
    release(lock, head);
  }
  count(got, spins);
}
