// Proxy geometry of point and spot lights, inflated so that a cell whose area (not only its centre) the light touches is
// covered.
#include "shaders/lights/light.glsl"
#include "shaders/lights/proxy_mesh.glsl"
#include "shaders/shared/view_block.glsl"

layout(std140, binding = UNIFORM_PASS) uniform Pass {
  LightPassParams params;
};

flat out uint vLight;

const float ROUNDED = 1.05;  // cells, so that what a rasteriser rounds hides none

void main() {
  vLight = uint(params.cells.w + gl_InstanceID);
  Proxy proxy = seenInSquare(lightProxy(vLight, view), ROUNDED * float(params.cells.z), view);
  vec3 pView = proxyVertex(gl_VertexID, proxy);
  vec4 clip = view.clipFromView * vec4(pView, 1.0);
  // The grid of whole cells may reach past the image's right and upper edge.
  vec2 image = vec2(view.size.xy) / vec2(params.cells.xy * params.cells.z);
  clip.xy = (clip.xy + clip.w) * image - clip.w;
  gl_Position = clip;
}
