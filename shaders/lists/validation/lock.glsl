// The critical section that the lock checks run: lock `i` guards the words guarded[i * WORDS …]. Whoever holds it adds
// one to the first by a plain read at the start and a plain write at the end, and leaves its own number in all the others, which are therefore
// equal whenever nobody is inside.
//
// ACQUIRE_EXCHANGE, ACQUIRE_COMPARE: how a lock is taken; ACQUIRE_HEAD: as in shaders/lists/insert.glsl, where the
// word is both a list's head and its lock. WORDS, SPIN_LIMIT, QUALIFIER (of what is guarded), BARRIER
// (before the lock is given back): numbers and words.
#include "shaders/shared/hash.glsl"

#if defined(MUTANT_NO_LOCK) && !defined(WITHOUT_LOCK)
#define WITHOUT_LOCK
#endif
#if defined(MUTANT_NO_BARRIER) && !defined(WITHOUT_BARRIER)
#define WITHOUT_BARRIER
#endif

layout(std430, binding = 0) coherent buffer Locks {
  uint locks[];
};
layout(std430, binding = 1) QUALIFIER buffer Guarded {
  uint guarded[];
};
layout(std430, binding = 2) coherent buffer Outcome {
  uint entered;   // sections that were run
  uint gaveUp;    // invocations that the bound of the spin stopped
  uint torn;      // sections that found the words of two others
  uint maxTries;  // for one lock
  uint gateInside;
  uint gateMet;   // two ran at the same time
  uint gateTries;
  uint tries[32]; // how many entered after up to 2^(i+1) - 1 tries
};
#include "shaders/lists/validation/gate.glsl"

// So many that gave up say enough: the others do not try, or a starving driver would take hours.
const uint GIVE_UPS_TOLD = 64u;

const uint LOCKED = 0xffffffffu;

bool acquire(uint lock, out uint head) {
  head = 0u;
#if defined(WITHOUT_LOCK)
  return true;
#elif defined(ACQUIRE_COMPARE)
  return atomicCompSwap(locks[lock], 0u, LOCKED) == 0u;
#else
  head = atomicExchange(locks[lock], LOCKED);
  return head != LOCKED;
#endif
}

void release(uint lock, uint head) {
#ifndef WITHOUT_BARRIER
  BARRIER();
#endif
#if defined(WITHOUT_LOCK)
#elif defined(ACQUIRE_HEAD)
  atomicExchange(locks[lock], head + 1u);
#else
  atomicExchange(locks[lock], 0u);
#endif
}

void section(uint lock, uint stamp) {
  uint first = lock * WORDS;
  uint before = guarded[first];
  uint found = guarded[first + 1u];
  bool whole = true;
  for (uint i = 1u; i < WORDS; ++i) {
    if (guarded[first + i] != found) whole = false;
  }
  for (uint i = 1u; i < WORDS; ++i) guarded[first + i] = stamp;
  guarded[first] = before + 1u;
  if (!whole) atomicAdd(torn, 1u);
}

uint spinLimit() {
  return atomicAdd(gaveUp, 0u) < GIVE_UPS_TOLD ? SPIN_LIMIT : 1u;
}

void count(bool done, uint spins) {
  if (done) {
    atomicAdd(entered, 1u);
    atomicAdd(tries[findMSB(spins)], 1u);
    atomicMax(maxTries, spins);
  } else {
    atomicAdd(gaveUp, 1u);
  }
}

// One section under lock `lock` by number `stamp`, as list code is to be written: the section stands inside the loop.
void lockOnce(uint lock, uint stamp) {
  bool done = false;
  uint spins = 0u;
  uint limit = spinLimit();
  while (!done && spins < limit) {
    ++spins;
    uint head;
    if (acquire(lock, head)) {
      section(lock, stamp);
      release(lock, head);
      done = true;
    }
  }
  count(done, spins);
}
