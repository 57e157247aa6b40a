// Writes, adds to and reads words past the end of its part of a buffer.
layout(local_size_x = 64) in;

layout(std430, binding = 0) coherent buffer Part {
  uint part[];
};
layout(std430, binding = 1) buffer Found {
  uint length;
  uint found[];
};

void main() {
  uint i = gl_LocalInvocationIndex;
  uint end = uint(part.length());
  if (i == 0u) length = end;
  uint places[6] = uint[](end + i, end + 1024u + i, 0x100000u + i, 0x40000000u + i, 0x7fffffffu - i, 0xffffffffu - i);
  uint sum = 0u;
  for (uint k = 0u; k < 6u; ++k) {
    sum |= part[places[k]];
    part[places[k]] = 0xbad0bad0u;
    atomicAdd(part[places[k]], 0x1000u);
    sum |= atomicExchange(part[places[k]], 0xbad1bad1u);
  }
  found[i] = sum;
}
