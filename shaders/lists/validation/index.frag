flat in uint number;
flat in float bits;
flat in float rounded;
flat in uint place;

layout(std430, binding = 1) buffer Found {
  uint found[];  // 64 that came as numbers, 64 as bits of floats, 64 as floats
};

void main() {
  uint told = number;
#ifdef MUTANT_FLOAT_INDEX
  told = uint(rounded);
#endif
  found[place] = told;
  found[64u + place] = floatBitsToUint(bits);
  found[128u + place] = uint(rounded);
}
