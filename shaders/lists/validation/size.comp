// Writes a value to each of some places in a large buffer, or (READ) reads it back; says how long the buffer is.
layout(local_size_x = 16) in;

layout(std430, binding = 0) buffer Data {
  uint data[];
};
layout(std430, binding = 1) buffer Probe {
  uint length;
  uint places[16];
  uint found[16];
};

void main() {
  uint i = gl_LocalInvocationIndex;
  uint place = places[i];
#ifdef MUTANT_SHORT_INDEX
  place &= 0xffffffu;
#endif
#ifdef READ
  found[i] = data[place];
#else
  data[place] = place ^ 0x5a5a5a5au;
#endif
  if (i == 0u) length = uint(data.length());
}
