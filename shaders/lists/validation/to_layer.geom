// Sends instance n of a triangle to layer n of the framebuffer.
layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;
flat in uint layer[];
flat out uint target;

void main() {
  for (int i = 0; i < 3; ++i) {
    gl_Position = gl_in[i].gl_Position;
    gl_Layer = int(layer[0]);
    target = layer[0];
    EmitVertex();
  }
  EndPrimitive();
}
