// What shaders/scene/surface.vert says of a fragment, where scene/covering.geom stood in between.
#include "shaders/scene/covered.glsl"
#include "shaders/shared/view_block.glsl"

flat in vec3 coveringOne;
flat in mat3 coveringPositionView;
flat in mat3 coveringNormalWorld;
flat in mat3x4 coveringTangentWorld;
flat in mat3x2 coveringUv0;
flat in mat3x2 coveringUv1;
flat in mat3x4 coveringColour;
flat in uint coveringDraw;

vec3 coveringAt = vec3(1.0, pixelsFromA(ivec2(gl_FragCoord.xy) + view.tile.xy));
float coveringW = 1.0 / dot(coveringOne, coveringAt);
vec3 vPositionView = coveringPositionView * coveringAt * coveringW;
vec3 vNormalWorld = coveringNormalWorld * coveringAt * coveringW;
vec4 vTangentWorld = coveringTangentWorld * coveringAt * coveringW;
vec2 vUv0 = coveringUv0 * coveringAt * coveringW;
vec2 vUv1 = coveringUv1 * coveringAt * coveringW;
vec4 vColour = coveringColour * coveringAt * coveringW;
uint vDraw = coveringDraw;
