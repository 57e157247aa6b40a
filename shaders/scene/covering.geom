// Rectangles of pixels in place of the triangles of surfaces (scene/surface.vert): scene/covering.glsl.
#include "shaders/scene/covering.glsl"

in vec3 vPositionView[];
in vec3 vNormalWorld[];
in vec4 vTangentWorld[];
in vec2 vUv0[];
in vec2 vUv1[];
in vec4 vColour[];
flat in uint vDraw[];

// Divided by w.
noperspective out float coveringOne;
noperspective out vec3 coveringPositionView;
noperspective out vec3 coveringNormalWorld;
noperspective out vec4 coveringTangentWorld;
noperspective out vec2 coveringUv0;
noperspective out vec2 coveringUv1;
noperspective out vec4 coveringColour;
flat out uint coveringDraw;

void emitInterpolated(dvec3 weights) {
  coveringOne = float(weights.x + weights.y + weights.z);
  coveringPositionView = vec3(dmat3(vPositionView[0], vPositionView[1], vPositionView[2]) * weights);
  coveringNormalWorld = vec3(dmat3(vNormalWorld[0], vNormalWorld[1], vNormalWorld[2]) * weights);
  coveringTangentWorld = vec4(dmat3x4(vTangentWorld[0], vTangentWorld[1], vTangentWorld[2]) * weights);
  coveringUv0 = vec2(dmat3x2(vUv0[0], vUv0[1], vUv0[2]) * weights);
  coveringUv1 = vec2(dmat3x2(vUv1[0], vUv1[1], vUv1[2]) * weights);
  coveringColour = vec4(dmat3x4(vColour[0], vColour[1], vColour[2]) * weights);
  coveringDraw = vDraw[0];
}
