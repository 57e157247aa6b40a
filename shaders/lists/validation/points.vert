// Points in the middle of the viewport.
flat out uint pointId;

void main() {
  gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
  pointId = uint(gl_VertexID);
}
