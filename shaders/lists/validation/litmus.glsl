// One thread of a litmus test: two operations on the words x and y of each of ROUNDS instances, a memory barrier between
// them (or none). What the operations are is data, so that one shader runs every test and no compiler sees through it.
// Thread and partner (the same lane elsewhere) meet before each instance, within bounds, and start a little apart.
//
// QUALIFIER: of the memory. INSTANCES: a power of two. ROUNDS, LANES (of all partners): INSTANCES is their product over
// LANES_AN_INSTANCE. WITH_BARRIER.
#include "shaders/lists/validation/random.glsl"

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
  uint meetings[];  // of each lane and its partner
};
layout(std430, binding = 3) readonly buffer Test {
  uint operations[8];  // two of each of four threads: see litmus_gpu.cpp
  uint seed;
  uint stress;
  uint threads;  // 2 or 4
};
#include "shaders/lists/validation/gate.glsl"

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
  uint thread = threads == 2u ? side : side * 2u + (lane & 1u);
  uint own = threads == 2u ? lane : lane >> 1;
  uint step = threads == 2u ? LANES : LANES / 2u;
  uint first = operations[thread * 2u];
  uint second = operations[thread * 2u + 1u];
#ifdef MUTANT_SWAPPED
  uint swap = first;
  first = second;
  second = swap;
#endif
  uint patience = 24000u;  // looks for the partner, over all rounds
  for (uint round = 0u; round < ROUNDS; ++round) {
    uint instance = round * step + own;
    uint chance = hash(instance * 4u + thread + seed);
    if (stress != 0u) {
      memory[2u * INSTANCES + chance % STRESS_WORDS] = chance;
      memory[2u * INSTANCES + (chance >> 12) % STRESS_WORDS] = chance;
    }
    uint met = atomicAdd(meetings[lane], 1u) + 1u;
    uint looks = round == 0u ? 12000u : 48u;
    while (met < 2u * (round + 1u) && looks != 0u && patience != 0u) {
      met = atomicAdd(meetings[lane], 0u);
      --looks;
      --patience;
    }
    uint delay = chance >> 24 & 3u;
    while (delay != 0u) {
      atomicAdd(ticket, 0u);
      --delay;
    }
    operate(first, instance);
#ifdef WITH_BARRIER
    memoryBarrier();
#endif
    operate(second, instance);
  }
}
