// What shaders/scene/surface.vert says of a fragment, where scene/covering.geom stood in between.
#include "shaders/scene/covered.glsl"

// Divided by w.
noperspective in float coveringOne;
noperspective in vec3 coveringPositionView;
noperspective in vec3 coveringNormalWorld;
noperspective in vec4 coveringTangentWorld;
noperspective in vec2 coveringUv0;
noperspective in vec2 coveringUv1;
noperspective in vec4 coveringColour;
flat in uint coveringDraw;

float coveringW = 1.0 / coveringOne;
vec3 vPositionView = coveringPositionView * coveringW;
vec3 vNormalWorld = coveringNormalWorld * coveringW;
vec4 vTangentWorld = coveringTangentWorld * coveringW;
vec2 vUv0 = coveringUv0 * coveringW;
vec2 vUv1 = coveringUv1 * coveringW;
vec4 vColour = coveringColour * coveringW;
uint vDraw = coveringDraw;
