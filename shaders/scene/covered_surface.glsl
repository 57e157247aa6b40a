// What shaders/scene/surface.vert says of a fragment, where scene/covering.geom stood in between: for scene/material.glsl.
#include "shaders/scene/covered.glsl"

flat in vec3 coveringOne;
flat in mat3 coveringPositionView;
flat in mat3 coveringNormalWorld;
flat in mat3x4 coveringTangentWorld;
flat in mat3x2 coveringUv0;
flat in mat3x2 coveringUv1;
flat in mat3x4 coveringColour;
flat in uint coveringDraw;

vec3 coveringPlace = vec3(1.0, coveringOffset(ivec2(gl_FragCoord.xy) + view.tile.xy));
float coveringW = 1.0 / dot(coveringOne, coveringPlace);
vec3 vPositionView = coveringPositionView * coveringPlace * coveringW;
vec3 vNormalWorld = coveringNormalWorld * coveringPlace * coveringW;
vec4 vTangentWorld = coveringTangentWorld * coveringPlace * coveringW;
vec2 vUv0 = coveringUv0 * coveringPlace * coveringW;
vec2 vUv1 = coveringUv1 * coveringPlace * coveringW;
vec4 vColour = coveringColour * coveringPlace * coveringW;
uint vDraw = coveringDraw;
