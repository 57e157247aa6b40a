// Draws triangles so that they cover all samples of the pixels whose centres they cover, with multisampling switched on: a
// geometry shader puts a rectangle of whole pixels in place of each, and fragments ask isCovered() (scene/covered.glsl)
// whether they are in the triangle. The viewport is the whole image. SUBPIXEL_BITS is the driver's.
//
// Which pixels these are is to be what the rasteriser itself makes of a triangle, so corners are clipped, projected and
// snapped in the order in which Mesa's software rasterisers do it, with their rounding.
#include "shaders/shared/view_block.glsl"

layout(triangles) in;
layout(triangle_strip, max_vertices = 28) out;  // a clipped triangle has up to nine corners, which make seven triangles

// Of the triangle: where the centre of pixel (x, y) is at (x, y) << SUBPIXEL_BITS; counter-clockwise.
flat out ivec4 coveringAB;
flat out ivec2 coveringC;

// Emits what is interpolated, without perspective: the sum of the three vertices' values times `weights` is the value
// divided by w; the sum of the weights is 1 / w.
void emitInterpolated(dvec3 weights);

struct Corner {
  vec4 clip;
  ivec2 snapped;
};
#define MAX_CORNERS 9

ivec2 snapped(vec2 window) {
  return ivec2(roundEven((window - 0.5) * float(1 << SUBPIXEL_BITS)));
}

// A corner of what is drawn: one fused operation scales and moves it.
Corner vertexCorner(vec4 clip) {
  precise float inverseW = 1.0 / clip.w;
  precise vec2 ndc = clip.xy * inverseW;
  dvec2 halfSize = dvec2(view.size.xy) * 0.5;
  return Corner(clip, snapped(vec2(dvec2(ndc) * halfSize + halfSize)));
}

// One that clipping makes; `t` of the way.
Corner cutCorner(vec4 from, vec4 to, float t) {
  precise vec4 clip = from + t * (to - from);
  precise float inverseW = 1.0 / clip.w;
  vec2 halfSize = vec2(view.size.xy) * 0.5;
  precise vec2 window = clip.xy * inverseW * halfSize + halfSize;
  return Corner(clip, snapped(window));
}

// How far inside a plane of the view volume: right, left, top, bottom, near, far.
float inside(vec4 clip, int plane) {
  float at = clip[plane >> 1];
  bool negative = (plane & 1) == (plane < 4 ? 0 : 1);
  return negative ? clip.w - at : clip.w + at;
}

// The part of a convex polygon that is inside; how many corners it has.
int clipped(inout Corner polygon[MAX_CORNERS], int count, int plane) {
  Corner kept[MAX_CORNERS];
  int keptCount = 0;
  for (int i = 0; i < count; ++i) {
    Corner a = polygon[i];
    Corner b = polygon[i + 1 < count ? i + 1 : 0];
    float insideA = inside(a.clip, plane);
    float insideB = inside(b.clip, plane);
    if (insideA >= 0.0) kept[keptCount++] = a;
    if ((insideA < 0.0) != (insideB < 0.0)) {
      bool fromB = abs(insideB) < abs(insideA) || (insideB >= 0.0 && insideB == -insideA);
      kept[keptCount++] = fromB ? cutCorner(b.clip, a.clip, insideB / (insideB - insideA))
                                : cutCorner(a.clip, b.clip, insideA / (insideA - insideB));
    }
  }
  polygon = kept;
  return keptCount;
}

// Twice the area of a triangle, positive where it is counter-clockwise.
double area(ivec2 a, ivec2 b, ivec2 c) {
  dvec2 ab = dvec2(b - a);
  dvec2 ac = dvec2(c - a);
  return ab.x * ac.y - ab.y * ac.x;
}

void emitRectangleCorner(ivec2 pixel, dmat3 weightsFromPlace) {
  dvec2 place = dvec2(2 * pixel) / dvec2(view.size.xy) - 1.0;
  gl_Position = vec4(place, 0.0, 1.0);
  gl_PrimitiveID = gl_PrimitiveIDIn;
  emitInterpolated(weightsFromPlace * dvec3(place, 1.0));
  EmitVertex();
}

// The rectangle of the pixels whose centres may be in the triangle; it winds as the triangle does.
void emitRectangle(ivec2 a, ivec2 b, ivec2 c, dmat3 weightsFromPlace) {
  double twiceArea = area(a, b, c);
  if (twiceArea == 0.0) return;
  ivec2 low = min(a, min(b, c)) + (1 << SUBPIXEL_BITS) - 1 >> SUBPIXEL_BITS;
  ivec2 high = (max(a, max(b, c)) >> SUBPIXEL_BITS) + 1;
  low = max(low, ivec2(0));
  high = min(high, view.size.xy);
  if (any(greaterThanEqual(low, high))) return;
  bool flipped = twiceArea < 0.0;
  for (int i = 0; i < 4; ++i) {
    coveringAB = flipped ? ivec4(b, a) : ivec4(a, b);
    coveringC = c;
    ivec2 far = ivec2(i & 1, i >> 1);
    emitRectangleCorner(low + (high - low) * (flipped ? far.yx : far), weightsFromPlace);
  }
  EndPrimitive();
}

void main() {
  Corner polygon[MAX_CORNERS];
  int count = 3;
  for (int i = 0; i < 3; ++i) polygon[i] = vertexCorner(gl_in[i].gl_Position);
  for (int plane = 0; plane < 6; ++plane) {
    vec3 distances = vec3(inside(gl_in[0].gl_Position, plane), inside(gl_in[1].gl_Position, plane),
                          inside(gl_in[2].gl_Position, plane));
    if (any(lessThan(distances, vec3(0.0)))) count = clipped(polygon, count, plane);
  }
  dmat3 clipFromWeights = dmat3(gl_in[0].gl_Position.xyw, gl_in[1].gl_Position.xyw, gl_in[2].gl_Position.xyw);
  // From a place in normalised device coordinates (Olano and Greer 1997); of what only rounding gives an area, the first
  // vertex's alone.
  dmat3 weights = dmat3(dvec3(0.0), dvec3(0.0), dvec3(1.0 / double(gl_in[0].gl_Position.w), 0.0, 0.0));
  if (determinant(clipFromWeights) != 0.0) weights = inverse(clipFromWeights);
  for (int i = 2; i < count; ++i)
    emitRectangle(polygon[0].snapped, polygon[i - 1].snapped, polygon[i].snapped, weights);
}
