// One thread of litmus tests: two operations on the words x and y of an instance, a memory barrier between them (or none),
// in one instance after the other. What the operations are is data, so that one shader runs all tests and no compiler sees
// through them. A thread and its partner (the same lane elsewhere) meet before each instance, within bounds, and start a
// little apart.
//
// QUALIFIER: of the memory. LANES: partners. ROUNDS: instances that each of them runs; LANES * ROUNDS is a power of two.
#include "shaders/shared/hash.glsl"

layout(std430, binding = 0) QUALIFIER buffer Memory {
  uint memory[];  // x of all instances, then y, then words for stress
};
layout(std430, binding = 1) buffer Results {
  uint results[];  // four of each instance
};
layout(std430, binding = 2) coherent buffer Meeting {
  uint gateInside;
  uint gateMet;
  uint gateTries;
  uint ticket;
  uint firstMeetings;
  uint meetings[];  // of each lane and its partner
};
layout(std430, binding = 3) readonly buffer Tests {
  uint seed;
  uint stress;
  uint tests;
  uint operations[];  // of each test: two of each of four threads (memory_model_gpu.cpp packs them), then how many threads
};
#include "shaders/lists/validation/gate.glsl"

const uint INSTANCES = LANES * ROUNDS;
const uint LOAD = 1u;
const uint STORE = 2u;
const uint ADD = 3u;
const uint PLAIN_ADD = 4u;  // what an addition would be that is not atomic
const uint STRESS_WORDS = 4096u;

void operate(uint operation, uint instance) {
  uint kind = operation & 7u;
  uint value = operation >> 4 & 15u;
  uint place = (operation >> 3 & 1u) == 0u
                   ? (instance * 40503u + seed) % INSTANCES
                   : INSTANCES + (instance * 27191u + seed * 3u) % INSTANCES;
  uint slot = instance * 4u + (operation >> 8);
#ifdef MUTANT_PLAIN_ADD
  if (kind == ADD) kind = PLAIN_ADD;
#endif
  if (kind == LOAD) {
    results[slot] = memory[place];
  } else if (kind == STORE) {
    memory[place] = value;
  } else if (kind == ADD) {
    results[slot] = atomicAdd(memory[place], value);
  } else if (kind == PLAIN_ADD) {
    uint before = memory[place];
    memory[place] = before + value;
    results[slot] = before;
  }
}

// `side`: 0 or 1, the two partners; `lane`: the same number for both, below LANES.
void litmus(uint side, uint lane) {
  // Looks for the partner: many in the first round, but only for a few lanes, in case there is none.
  uint looks = atomicAdd(firstMeetings, 1u) < 8u * GATE_TRIES ? 12000u : 500u;
  for (uint round = 0u; round < ROUNDS; ++round) {
    uint test = round % tests * 9u;
    bool two = operations[test + 8u] == 2u;
    uint thread = two ? side : side * 2u + (lane & 1u);
    uint instance = round * LANES + (two ? lane : lane >> 1);
    uint first = operations[test + thread * 2u];
    uint second = operations[test + thread * 2u + 1u];
#ifdef MUTANT_SWAPPED
    uint swap = first;
    first = second;
    second = swap;
#endif
    uint chance = hash(instance * 4u + thread + seed);
    if (stress != 0u) {
      memory[2u * INSTANCES + chance % STRESS_WORDS] = chance;
      memory[2u * INSTANCES + (chance >> 12) % STRESS_WORDS] = chance;
    }
    uint met = atomicAdd(meetings[lane], 1u) + 1u;
    while (met < 2u * (round + 1u) && looks != 0u) {
      met = atomicAdd(meetings[lane], 0u);
      --looks;
    }
    looks = 48u;
    uint delay = chance >> 24 & 3u;
    while (delay != 0u) {
      atomicAdd(ticket, 0u);
      --delay;
    }
    operate(first, instance);
    if ((round / tests & 1u) == 0u) memoryBarrier();
    operate(second, instance);
  }
}
