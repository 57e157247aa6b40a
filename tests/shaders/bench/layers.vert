// Layers that cover the whole target, an instance each.
flat out uint vLayer;

void main() {
  vLayer = uint(gl_InstanceID);
  gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
