// A triangle about the centre of the only pixel, too small to hold any other sample.
void main() {
  gl_Position = vec4((vec2(gl_VertexID & 1, gl_VertexID >> 1) - 0.25) * 0.1, 0.0, 1.0);
}
