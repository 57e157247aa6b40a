// The order of nodes: by depth, then by id. Depths are compared as integers, so that every bit pattern has its place.
int listRank(uint depthBits) {
  int bits = int(depthBits);
  return bits ^ ((bits >> 31) & 0x7fffffff);
}

bool listBefore(uvec2 a, uvec2 b) {
  int rankA = listRank(a.x);
  int rankB = listRank(b.x);
  return rankA < rankB || (rankA == rankB && a.y < b.y);
}

// The key of a node; there is one zero.
uvec2 listKey(float depth, uint id) {
  return uvec2(depth == 0.0 ? 0u : floatBitsToUint(depth), id);
}
