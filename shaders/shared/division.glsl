// Integers are divided through floats: drivers that run on vectors divide them one after the other.

// Of a and b below 2^31. The first quotient is off by a 2^22nd of itself, the second by 1.
uint quotient(uint a, uint b) {
  float scale = 1.0 / float(b);
  uint q = uint(float(a) * scale);
  q += uint(int(floor(float(int(a - q * b)) * scale)));
  int left = int(a - q * b);
  if (left < 0) --q;
  if (left >= int(b)) ++q;
  return q;
}

// Column and row of the number-th place, row by row.
ivec2 placeInRows(uint number, int width) {
  uint row = quotient(number, uint(width));
  return ivec2(int(number - row * uint(width)), int(row));
}

// Of what is not negative.
ivec2 quotient(ivec2 a, int b) {
  return ivec2(quotient(uint(a.x), uint(b)), quotient(uint(a.y), uint(b)));
}
