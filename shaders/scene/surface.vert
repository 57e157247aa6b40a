// Every mesh of every pass: the camera's and the lights'.
#include "shaders/scene/draws.glsl"
#include "shaders/shared/view_block.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 tangent;
layout(location = 3) in vec2 uv0;
layout(location = 4) in vec2 uv1;
layout(location = 5) in vec4 colour;
layout(location = 6) in uint drawNumber;

out vec3 vPositionView;
out vec3 vNormalWorld;
out vec4 vTangentWorld;
out vec2 vUv0;
out vec2 vUv1;
out vec4 vColour;
flat out uint vDraw;

invariant gl_Position;  // what is drawn again meets its own depth

void main() {
  DrawData draw = drawAt(drawNumber);
  vec4 pWorld = draw.worldFromObject * vec4(position, 1.0);
  vec4 pView = view.viewFromWorld * vec4(pWorld.xyz, 1.0);
  vPositionView = pView.xyz;
  vNormalWorld = mat3(draw.normalFromObject) * normal;
  vTangentWorld = vec4(mat3(draw.worldFromObject) * tangent.xyz, tangent.w);
  vUv0 = uv0;
  vUv1 = uv1;
  vColour = colour;
  vDraw = drawNumber;
  gl_Position = view.clipFromView * pView;
}
