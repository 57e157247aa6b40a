// A triangle over the whole viewport at depth DEPTH, in [0, 1].
void main() {
  vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  gl_Position = vec4(corner, DEPTH * 2.0 - 1.0, 1.0);
}
