// Workgroups, or patches, that start together: the first waits, within bounds, until a second one is there, so that
// what follows runs at the same time where a driver can do that. One invocation of each calls it.
void gate() {
  uint there = atomicAdd(arrived, 1u) + 1u;
  for (uint polls = 0u; there < 2u && polls < 20000u; ++polls) there = atomicAdd(arrived, 0u);
}
