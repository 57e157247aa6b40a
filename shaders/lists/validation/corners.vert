// Triangles with their right angle in the lower left corner: instance n covers the pixels (x, y) with x + y <= n, and no
// pixel's centre is on an edge.
flat out uint number;

void main() {
  float side = float(gl_InstanceID) + 1.5;
  vec2 corner = vec2(gl_VertexID == 1 ? side : 0.0, gl_VertexID == 2 ? side : 0.0);
  gl_Position = vec4(corner / float(SIDE) * 2.0 - 1.0, 0.0, 1.0);
  number = uint(gl_InstanceID);
}
