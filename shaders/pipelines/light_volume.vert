// What a light reaches, as a mesh; the whole image for a directional light.
#include "shaders/lights/light.glsl"
#include "shaders/lights/proxy_mesh.glsl"
#include "shaders/shared/resolve_block.glsl"
#include "shaders/shared/view_block.glsl"

void main() {
  uint number = uint(params.options.w);
  if (lightAt(number).indices.x == LIGHT_DIRECTIONAL) {
    gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0);
  } else {
    gl_Position = view.clipFromView * vec4(proxyVertex(gl_VertexID, lightProxy(number, view)), 1.0);
  }
}
