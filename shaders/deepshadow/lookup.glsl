// How much of a light gets to a point. Every function here reads maps that deepshadow/maps_gpu built.
#include "shaders/shared/bindings.h"
#include "shaders/shared/deepshadow.h"

layout(std430, binding = STORAGE_SHADOW_FACES) readonly buffer Faces {
  ShadowFace shadowFaces[];
};
layout(std430, binding = STORAGE_SHADOW_TEXELS) readonly buffer Texels {
  ShadowTexel shadowTexels[];
};
layout(std430, binding = STORAGE_SHADOW_KNOTS) readonly buffer Knots {
  ShadowKnot shadowKnots[];
};

// Optical depth from the light to `depth` in the run of a texel: the last knot at or before it is found by bisection,
// tau is linear from there to the next one.
vec3 opticalDepthAt(uint first, uint count, float depth) {
  uint low = 0u;
  uint high = count;  // knots [0, low) are at or before depth, knots [high, count) are behind it
  while (low < high) {
    uint middle = (low + high) >> 1;
    if (shadowKnots[first + middle].depth <= depth) low = middle + 1u;
    else high = middle;
  }
  if (low == 0u) return vec3(0.0);
  ShadowKnot before = shadowKnots[first + low - 1u];
  vec3 tau = vec3(before.tauR, before.tauG, before.tauB);
  if (low < count) {
    ShadowKnot after = shadowKnots[first + low];
    float along = (depth - before.depth) / (after.depth - before.depth);
    tau += along * (vec3(after.tauR, after.tauG, after.tauB) - tau);
  }
  return tau;
}

vec3 texelTransmittance(uint texel, float depth) {
  ShadowTexel run = shadowTexels[texel];
  if (depth > run.opaqueDepth) return vec3(0.0);
  if (run.count == 0u) return vec3(1.0);
  return exp(-opticalDepthAt(run.first, run.count, depth));
}

// Of a light's `faces` (1, or the 6 of a cube: +x -x +y -y +z -z) the one that sees a point `toPoint` away from it.
int faceTowards(int faces, vec3 toPoint) {
  if (faces == 1) return 0;
  vec3 size = abs(toPoint);
  int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
  return axis * 2 + (toPoint[axis] < 0.0 ? 1 : 0);
}

// Texel position (centres at .5) and depth of a point in a face.
vec3 placeInFace(ShadowFace face, vec3 pWorld) {
  vec3 p = (face.faceFromWorld * vec4(pWorld, 1.0)).xyz;
  float depth = -p.z;
  vec2 xy = face.texels.z != 0 ? p.xy / max(depth, 1e-20) : p.xy;
  return vec3(xy * face.projection.xy + face.projection.zw, depth);
}

uint texelNumber(ShadowFace face, ivec2 texel) {
  texel = clamp(texel, ivec2(0), ivec2(face.texels.y - 1));
  return uint(face.texels.x + texel.y * face.texels.y + texel.x);
}

// Of a point in smoke: the nearest texel, or the four around it when `bilinear`.
vec3 shadowInSmoke(int firstFace, int faces, vec3 lightPosition, vec3 pWorld, bool bilinear) {
  ShadowFace face = shadowFaces[firstFace + faceTowards(faces, pWorld - lightPosition)];
  vec3 place = placeInFace(face, pWorld);
  if (!bilinear) return texelTransmittance(texelNumber(face, ivec2(floor(place.xy))), place.z);
  vec2 corner = floor(place.xy - 0.5);
  vec2 weight = place.xy - 0.5 - corner;
  vec3 sum = vec3(0.0);
  for (int i = 0; i < 4; ++i) {
    ivec2 offset = ivec2(i & 1, i >> 1);
    vec2 side = mix(1.0 - weight, weight, vec2(offset));
    sum += side.x * side.y * texelTransmittance(texelNumber(face, ivec2(corner) + offset), place.z);
  }
  return sum;
}

// Of a point on a surface with the plane normal `normal`: the four texels around it, each asked at the depth at which
// the ray through its centre meets that plane, so that a surface neither shadows itself nor leaks, whatever the angle
// and the resolution; what is left over is float rounding.
vec3 shadowOnSurface(int firstFace, int faces, vec3 lightPosition, vec3 pWorld, vec3 normal) {
  ShadowFace face = shadowFaces[firstFace + faceTowards(faces, pWorld - lightPosition)];
  vec3 place = placeInFace(face, pWorld);
  vec3 p = (face.faceFromWorld * vec4(pWorld, 1.0)).xyz;
  vec3 n = mat3(face.faceFromWorld) * normal;
  bool perspective = face.texels.z != 0;
  vec2 corner = floor(place.xy - 0.5);
  vec2 weight = place.xy - 0.5 - corner;
  vec3 sum = vec3(0.0);
  for (int i = 0; i < 4; ++i) {
    ivec2 offset = ivec2(i & 1, i >> 1);
    vec2 side = mix(1.0 - weight, weight, vec2(offset));
    vec2 xy = (corner + vec2(offset) + 0.5 - face.projection.zw) / face.projection.xy;
    // The plane dot(n, x) = dot(n, p), met by x = (xy depth, -depth) or x = (xy, -depth).
    float depth = perspective ? dot(n, p) / dot(n, vec3(xy, -1.0)) : (dot(n.xy, xy) - dot(n, p)) / n.z;
    // A plane seen edge-on meets the ray far away or nowhere; no light falls on it, and its own depth will do.
    float slack = 4.0 / face.projection.x * (perspective ? place.z : 1.0);
    float steep = 64.0 * slack;
    depth = abs(depth - place.z) < steep ? depth : place.z;
    depth -= 1e-4 * place.z + 1e-3 * slack;
    sum += side.x * side.y * texelTransmittance(texelNumber(face, ivec2(corner) + offset), depth);
  }
  return sum;
}
