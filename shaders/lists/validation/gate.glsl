// Makes what follows run at the same time in two places, where a driver can do that: one invocation of each workgroup
// (or block of fragments) calls gate(), and the first ones wait there, within bounds, until they see another inside.
// Needs GATE_TRIES (how many may wait in vain) and the words gateInside, gateMet, gateTries, all 0 at first.
const uint GATE_POLLS = 20000u;

void gate() {
  uint inside = atomicAdd(gateInside, 1u) + 1u;
  uint met = atomicAdd(gateMet, 0u);
  if (met == 0u && atomicAdd(gateTries, 1u) < GATE_TRIES) {
    for (uint polls = 0u; inside < 2u && met == 0u && polls < GATE_POLLS; ++polls) {
      inside = atomicAdd(gateInside, 0u);
      met = atomicAdd(gateMet, 0u);
    }
  }
  if (inside > 1u) atomicOr(gateMet, 1u);
  atomicAdd(gateInside, 0xffffffffu);
}
