// t = 1 - a (1 - tau b): what passes, for the eye and for light alike.
vec3 passThrough(vec4 base, float tau) {
  return clamp(1.0 - base.a * (1.0 - tau * base.rgb), 0.0, 1.0);
}
