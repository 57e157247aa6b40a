// How much of a light gets to a point, by the maps that deepshadow/interlaced_maps_gpu built; the same functions as
// lookup.glsl has for deep ones. Lines are told apart first (Aladagli 2015, Eq. 3.1), depths compared then, and what comes of
// that is filtered last.
#include "shaders/deepshadow/faces.glsl"

layout(binding = TEXTURE_SHADOW_TEXELS) uniform sampler2D shadowDepths;  // below 0: of a translucent surface
layout(binding = TEXTURE_SHADOW_KNOTS) uniform sampler2D shadowFilters;  // what that lets through; alpha takes of it

// Maps of depths alone have no lines to tell apart.
#ifdef PLAIN_SHADOWS
const bool INTERLACED = false;
#else
const bool INTERLACED = true;
#endif

// Where a texel of a face stands in the textures. Lines beyond an edge are those before it, so that odd ones stay odd.
ivec2 placeOf(ShadowFace face, ivec2 texel) {
  int last = face.texels.y - 1;
  int line = last - abs(last - abs(texel.y));
  return ivec2(face.texels.w + clamp(texel.x, 0, last), face.texels.x / face.texels.y + line);
}

float depthOf(ShadowFace face, ivec2 texel) {
  return texelFetch(shadowDepths, placeOf(face, texel), 0).r;
}

vec3 letThrough(ShadowFace face, ivec2 texel) {
  vec4 colour = texelFetch(shadowFilters, placeOf(face, texel), 0);
  return colour.rgb * (1.0 - colour.a);
}

// What a texel tells of a point, or several of them together.
struct Told {
  bool translucent;  // else it tells of an opaque surface
  float weight;      // of that; 0 where it cannot tell whether the surface is before the point
  float lit;         // the part of the weight that is not behind it
  vec3 passing;      // through translucent surfaces before the point
};

// Of what the texels of three lines of a column tell, what holds at the middle one, `own`, which is an odd one or not.
// Shares are those of the lines `below` and `above`.
Told deinterlaced(Told below, Told own, Told above, bool odd, vec2 shares) {
  if (own.translucent) {
    own.weight = dot(shares, vec2(below.weight, above.weight));
    own.lit = dot(shares, vec2(below.lit, above.lit));
  } else if (!odd) {
    // An opaque surface that hides the point tells nothing about translucent ones behind it.
    vec2 tell = shares * vec2(below.translucent ? 1.0 : below.lit, above.translucent ? 1.0 : above.lit);
    if (tell.x + tell.y > 0.0) own.passing = (tell.x * below.passing + tell.y * above.passing) / (tell.x + tell.y);
  }
  return own;
}

// One texel alone, as the thesis has it, asks the line below; others interpolate between the lines on both sides.
vec2 sharesOfLines(int side) {
  return side == 1 ? vec2(1.0, 0.0) : vec2(0.5);
}

Told toldInSmoke(ShadowFace face, ivec2 texel, float depth) {
  float surface = depthOf(face, texel);
  bool translucent = surface < 0.0;
  bool before = abs(surface) < depth;
  return Told(translucent, 1.0, before ? 0.0 : 1.0, translucent && before ? letThrough(face, texel) : vec3(1.0));
}

int texelsOfFace(ShadowFace face) {
  return face.texels.y * face.texels.y;
}

// Of a point in smoke, in the view space of the face that sees it; `side`: see Taps.
vec3 shadowInSmoke(ShadowFace face, vec3 pFace, int side) {
  float depth = -pFace.z;
  vec2 xy = face.texels.z != 0 ? pFace.xy / max(depth, 1e-20) : pFace.xy;
  Taps taps = tapsAround(xy * face.projection.xy + face.projection.zw, side);
  vec3 sum = vec3(0.0);
  for (int x = 0; x < side; ++x) {
    ivec2 at = taps.first + ivec2(x, 0);
    Told own = toldInSmoke(face, at, depth);
    Told below = own;
    if (INTERLACED) below = toldInSmoke(face, at - ivec2(0, 1), depth);
    Told above = below;
    for (int y = 0; y < side; ++y) {
      if (y + 1 < side || (INTERLACED && side > 1)) above = toldInSmoke(face, at + ivec2(0, y + 1), depth);
      Told told = own;
      if (INTERLACED) told = deinterlaced(below, own, above, ((at.y + y) & 1) != 0, sharesOfLines(side));
      sum += taps.x[x] * taps.y[y] * told.lit * told.passing;
      below = own;
      own = above;
    }
  }
  return sum;
}

// A point of a surface that asks, in the view space of a face.
struct Receiver {
  vec3 p;
  vec3 n;
  float depth;
  vec2 place;  // texels
  float texelWidth;
  float rounding;
};

// As opaqueDepthFrom() in lookup.glsl. Where a texel beside it shows something translucent, the line below tells how the
// depth changes along the lines, and the one after the next how it does across them.
float opaqueDepthFrom(ShadowFace face, ivec2 texel, float depth, vec2 offset) {
  ivec2 outwards = ivec2(sign(offset));
  vec2 own = vec2(depth);
  vec2 beside = vec2(depthOf(face, texel + ivec2(outwards.x, 0)), depthOf(face, texel + ivec2(0, outwards.y)));
  vec2 per = abs(offset);
  if (beside.x < 0.0) {
    own.x = depthOf(face, texel - ivec2(0, 1));
    beside.x = depthOf(face, texel + ivec2(outwards.x, -1));
  }
  if (beside.y < 0.0) {
    beside.y = depthOf(face, texel + ivec2(0, 2 * outwards.y));
    per.y *= 0.5;
  }
  if (face.texels.z == 0) return depth + dot(per, own - beside);
  float inverse = 1.0 / depth + dot(per, 1.0 / own - 1.0 / beside);
  return inverse > 0.0 ? 1.0 / inverse : NOTHING_OPAQUE;
}

// The texel is asked at the depth at which the ray through its centre meets the receiver's plane: see shadowOnSurface() in
// lookup.glsl.
Told toldOnSurface(ShadowFace face, Receiver receiver, ivec2 texel) {
  vec3 n = receiver.n;
  vec2 xy = (vec2(texel) + 0.5 - face.projection.zw) / face.projection.xy;
  float toPlane = dot(n, receiver.p);
  float depth = face.texels.z != 0 ? toPlane / dot(n, vec3(xy, -1.0)) : (dot(n.xy, xy) - toPlane) / n.z;
  if (!(abs(depth - receiver.depth) < 512.0 * receiver.texelWidth)) depth = receiver.depth;
  float slack = receiver.texelWidth + 0.3 * abs(depth - receiver.depth);
  depth -= receiver.rounding;
  float surface = depthOf(face, texel);
  Told told = Told(surface < 0.0, 1.0, 1.0, vec3(1.0));
  if (told.translucent) {
    if (-surface < depth - slack) told.passing = letThrough(face, texel);
  } else if (depth <= surface) {
    bool grazing = surface > depth + 4.0 * receiver.rounding && surface < receiver.depth - receiver.texelWidth;
    if (grazing) told.weight = told.lit = 1e-6;
  } else {
    bool blocked = min(depth, receiver.depth) - slack > surface &&
                   opaqueDepthFrom(face, texel, surface, vec2(texel) + 0.5 - receiver.place) < receiver.depth - slack;
    told.lit = 0.0;
    if (!blocked) told.weight = 0.0;
  }
  return told;
}

// Of a point on a surface with the plane normal `normal`; see lookup.glsl. There are no objects in these maps.
vec3 shadowOnSurface(int firstFace, int faces, vec3 lightPosition, vec3 pWorld, vec3 normal, uint object,
                     int side) {
  ShadowFace face = shadowFaceAt(firstFace + faceTowards(faces, pWorld - lightPosition));
  bool perspective = face.texels.z != 0;
  Receiver receiver;
  receiver.p = (face.faceFromWorld * vec4(pWorld, 1.0)).xyz;
  receiver.n = mat3(face.faceFromWorld) * normal;
  receiver.depth = -receiver.p.z;
  receiver.place = (perspective ? receiver.p.xy / max(receiver.depth, 1e-20) : receiver.p.xy) * face.projection.xy +
                   face.projection.zw;
  receiver.texelWidth = (perspective ? receiver.depth : 1.0) / min(face.projection.x, face.projection.y);
  receiver.rounding = 1e-4 * abs(receiver.depth) + 1e-3 * receiver.texelWidth;
  Taps taps = tapsAround(receiver.place, side);
  vec3 sum = vec3(0.0);
  float weight = 0.0;
  vec3 doubtful = vec3(0.0);
  for (int x = 0; x < side; ++x) {
    ivec2 at = taps.first + ivec2(x, 0);
    Told own = toldOnSurface(face, receiver, at);
    Told below = own;
    if (INTERLACED) below = toldOnSurface(face, receiver, at - ivec2(0, 1));
    Told above = below;
    for (int y = 0; y < side; ++y) {
      if (y + 1 < side || (INTERLACED && side > 1)) above = toldOnSurface(face, receiver, at + ivec2(0, y + 1));
      Told told = own;
      if (INTERLACED) told = deinterlaced(below, own, above, ((at.y + y) & 1) != 0, sharesOfLines(side));
      float share = taps.x[x] * taps.y[y];
      sum += share * told.lit * told.passing;
      weight += share * told.weight;
      doubtful += share * told.passing;
      below = own;
      own = above;
    }
  }
  return weight > 0.0 ? sum / weight : doubtful;
}
