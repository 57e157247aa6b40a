// Every atomic operation, by every invocation: on a word of its own, where what it returns and leaves is known exactly,
// and on one word that all use.
//
// TYPE: uint or int. IN_BUFFER, IN_SHARED, IN_IMAGE: where the words are; IMAGE, LAYOUT: the image's type and format.
// IN_COUNTER: atomic counters instead, one that goes up and one that goes down.
#include "shaders/shared/hash.glsl"

const uint INVOCATIONS = 64u;  // invocations
const uint OPERATIONS = 8u;
const uint SLOTS = (INVOCATIONS + 1u) * OPERATIONS;

layout(std430, binding = 0) coherent buffer Words {
  TYPE words[];
};
layout(std430, binding = 1) writeonly buffer Returned {
  TYPE returned[];
};
#if defined(IN_COUNTER)
layout(binding = 0, offset = 0) uniform atomic_uint up;
layout(binding = 0, offset = 4) uniform atomic_uint down;

void runOperations(uint id) {
  returned[id] = atomicCounterIncrement(up);
  returned[INVOCATIONS + id] = atomicCounterDecrement(down);
}
#else
#if defined(IN_IMAGE)
layout(LAYOUT, binding = 0) coherent uniform IMAGE memory;
#define WORD(slot) memory, ivec2(int(slot), 0)
#define ADD imageAtomicAdd
#define MIN imageAtomicMin
#define MAX imageAtomicMax
#define AND imageAtomicAnd
#define OR imageAtomicOr
#define XOR imageAtomicXor
#define EXCHANGE imageAtomicExchange
#define COMPARE imageAtomicCompSwap
#else
#if defined(IN_SHARED)
shared TYPE memory[SLOTS];
#define WORD(slot) memory[slot]
#else
#define WORD(slot) words[slot]
#endif
#define ADD atomicAdd
#define MIN atomicMin
#define MAX atomicMax
#define AND atomicAnd
#define OR atomicOr
#define XOR atomicXor
#define EXCHANGE atomicExchange
#define COMPARE atomicCompSwap
#endif

TYPE operate(uint operation, uint slot, TYPE value, TYPE expected) {
#ifdef MUTANT_NO_ATOMIC
  if (operation == 0u) {
    TYPE before = words[slot];
    words[slot] = before + value;
    return before;
  }
#endif
  switch (operation) {
    case 0u: return ADD(WORD(slot), value);
    case 1u: return MIN(WORD(slot), value);
    case 2u: return MAX(WORD(slot), value);
    case 3u: return AND(WORD(slot), value);
    case 4u: return OR(WORD(slot), value);
    case 5u: return XOR(WORD(slot), value);
    case 6u: return EXCHANGE(WORD(slot), value);
    default: return COMPARE(WORD(slot), expected, value);
  }
}

// Words are hashes of their slots at first, operands of the slot after all of them; every other comparison holds.
void runOperations(uint id) {
  for (uint operation = 0u; operation < OPERATIONS; ++operation) {
    uint slot = operation * (INVOCATIONS + 1u) + id;
    uint together = operation * (INVOCATIONS + 1u) + INVOCATIONS;
    TYPE value = TYPE(hash(SLOTS + slot + SEED));
    uint expected = hash(slot + SEED) + (id & 1u);
    returned[slot] = operate(operation, slot, value, TYPE(expected));
    returned[SLOTS + slot] = operate(operation, together, value, TYPE(hash(together + SEED)));
  }
}
#endif
