// Rectangles of pixels in place of the triangles of surfaces (scene/surface.vert): scene/covering.glsl.
#include "shaders/scene/covering.glsl"

in vec3 vPositionView[];
in vec3 vNormalWorld[];
in vec4 vTangentWorld[];
in vec2 vUv0[];
in vec2 vUv1[];
in vec4 vColour[];
flat in uint vDraw[];

// Times (1, x, y): divided by w, x and y pixels from the first corner.
flat out vec3 coveringOne;
flat out mat3 coveringPositionView;
flat out mat3 coveringNormalWorld;
flat out mat3x4 coveringTangentWorld;
flat out mat3x2 coveringUv0;
flat out mat3x2 coveringUv1;
flat out mat3x4 coveringColour;
flat out uint coveringDraw;

void interpolate(dmat3 weights) {
  coveringOne = vec3(dvec3(1.0) * weights);
  coveringPositionView = mat3(dmat3(vPositionView[0], vPositionView[1], vPositionView[2]) * weights);
  coveringNormalWorld = mat3(dmat3(vNormalWorld[0], vNormalWorld[1], vNormalWorld[2]) * weights);
  coveringTangentWorld = mat3x4(dmat3x4(vTangentWorld[0], vTangentWorld[1], vTangentWorld[2]) * weights);
  coveringUv0 = mat3x2(dmat3x2(vUv0[0], vUv0[1], vUv0[2]) * weights);
  coveringUv1 = mat3x2(dmat3x2(vUv1[0], vUv1[1], vUv1[2]) * weights);
  coveringColour = mat3x4(dmat3x4(vColour[0], vColour[1], vColour[2]) * weights);
  coveringDraw = vDraw[0];
}
