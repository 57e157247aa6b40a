// What every lookup in a shadow map starts with: the face of a light that sees a point, and its texels around there.
#include "shaders/shared/bindings.h"
#include "shaders/shared/deepshadow.h"

layout(binding = TEXTURE_SHADOW_FACES) uniform usamplerBuffer faceRows;  // of ShadowFace, gl::Records

ShadowFace shadowFaceAt(int number) {
  int row = 7 * number;
  return ShadowFace(mat4(uintBitsToFloat(texelFetch(faceRows, row)), uintBitsToFloat(texelFetch(faceRows, row + 1)),
                         uintBitsToFloat(texelFetch(faceRows, row + 2)), uintBitsToFloat(texelFetch(faceRows, row + 3))),
                    uintBitsToFloat(texelFetch(faceRows, row + 4)), ivec4(texelFetch(faceRows, row + 5)),
                    uintBitsToFloat(texelFetch(faceRows, row + 6)));
}

// Of a light's `faces` (1, or the 6 of a cube: +x -x +y -y +z -z) the one that sees a point `toPoint` away from it.
int faceTowards(int faces, vec3 toPoint) {
  if (faces == 1) return 0;
  vec3 size = abs(toPoint);
  int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
  return axis * 2 + (toPoint[axis] < 0.0 ? 1 : 0);
}

// A point `toPoint` away from the light in the view space of a cube's face; the same axes as shadowFaces() in C++.
vec3 inCubeFace(int face, vec3 toPoint) {
  float s = (face & 1) == 0 ? 1.0 : -1.0;
  if (face < 2) return vec3(toPoint.z * s, toPoint.y, -toPoint.x * s);
  if (face < 4) return vec3(-toPoint.z * s, toPoint.x, -toPoint.y * s);
  return vec3(-toPoint.x * s, toPoint.y, -toPoint.z * s);
}

// The texels that a lookup asks: side x side of them from `first` on. Weights are those of a B-spline of order `side`:
// 1 the nearest, 2 bilinear, 4 soft.
struct Taps {
  ivec2 first;
  vec4 x;
  vec4 y;
};

// Where tap i of side x side is, from the first one. Sides are 1, 2 and 4.
ivec2 tapOffset(int i, int side) {
  return ivec2(i & (side - 1), i >> (side >> 1));
}

Taps tapsAround(vec2 place, int side) {
  Taps taps = Taps(ivec2(floor(place)), vec4(1.0), vec4(1.0));
  if (side == 1) return taps;
  vec2 corner = floor(place - 0.5);
  vec2 f = place - 0.5 - corner;
  vec2 g = 1.0 - f;
  taps.first = ivec2(corner);
  taps.x.xy = vec2(g.x, f.x);
  taps.y.xy = vec2(g.y, f.y);
  if (side == 2) return taps;
  vec2 first = g * g * g / 6.0;
  vec2 last = f * f * f / 6.0;
  vec2 second = 2.0 / 3.0 - f * f * (1.0 - 0.5 * f);
  vec2 third = 1.0 - first - second - last;
  taps.first -= 1;
  taps.x = vec4(first.x, second.x, third.x, last.x);
  taps.y = vec4(first.y, second.y, third.y, last.y);
  return taps;
}
