// Triangles about the centre of the only pixel, too small to hold any other sample.
void main() {
  int corner = gl_VertexID % 3;
  gl_Position = vec4((vec2(corner & 1, corner >> 1) - 0.25) * 0.1, 0.0, 1.0);
}
