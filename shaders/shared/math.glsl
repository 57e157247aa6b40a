const float PI = 3.14159265358979;

float maxComponent(vec3 v) {
  return max(v.r, max(v.g, v.b));
}

// So that what is one number or three is written once.
float maxComponent(float x) {
  return x;
}

float minComponent(float x) {
  return x;
}

float minComponent(vec3 v) {
  return min(v.r, min(v.g, v.b));
}

// Octahedral mapping of a unit vector to [-1, 1]^2 and back (Cigolle et al. 2014).
vec2 octahedralFromUnit(vec3 n) {
  vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
  vec2 sides = vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
  return n.z >= 0.0 ? p : (1.0 - abs(p.yx)) * sides;
}

vec3 unitFromOctahedral(vec2 p) {
  vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
  float fold = max(-n.z, 0.0);
  n.x += n.x >= 0.0 ? -fold : fold;
  n.y += n.y >= 0.0 ? -fold : fold;
  return normalize(n);
}
