// Draws triangles so that they cover all samples of the pixels whose centres they cover, with multisampling switched on: a
// geometry shader puts a rectangle of whole pixels in place of each, and fragments ask isCovered() (scene/covered.glsl)
// whether they are in the triangle. The viewport is the whole image. SUBPIXEL_BITS is the driver's.
//
// Which pixels these are is to be what the rasteriser itself makes of a triangle, so corners are clipped, projected and
// snapped in the order in which Mesa's software rasterisers do it, with their rounding.
#include "shaders/shared/view_block.glsl"

layout(triangles) in;
layout(triangle_strip, max_vertices = 4) out;

// Of what clipping leaves of the triangle, counter-clockwise, two in each vector; the centre of pixel (x, y) is at
// (x, y) << SUBPIXEL_BITS.
flat out ivec4 coveringCorners[5];
flat out int coveringCount;

// Hands on what is interpolated: at (x, y) pixels from the first corner the sum of the three vertices' values times weights * (1, x, y)
// is the value divided by w, and the sum of these weights is 1 / w.
void interpolate(dmat3 weights);

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

// Twice the area, positive where the polygon is counter-clockwise.
double area(Corner polygon[MAX_CORNERS], int count) {
  double sum = 0.0;
  for (int i = 2; i < count; ++i) {
    dvec2 a = dvec2(polygon[i - 1].snapped - polygon[0].snapped);
    dvec2 b = dvec2(polygon[i].snapped - polygon[0].snapped);
    sum += a.x * b.y - a.y * b.x;
  }
  return sum;
}

// The rectangle of the pixels whose centres may be in the polygon; it winds as the polygon does.
void emitRectangle(Corner polygon[MAX_CORNERS], int count, dmat3 weightsFromPlace) {
  double twiceArea = area(polygon, count);
  ivec2 a = polygon[0].snapped;
  ivec2 low = a;
  ivec2 high = a;
  for (int i = 1; i < count; ++i) {
    low = min(low, polygon[i].snapped);
    high = max(high, polygon[i].snapped);
  }
  low = max(low + (1 << SUBPIXEL_BITS) - 1 >> SUBPIXEL_BITS, ivec2(0));
  high = min((high >> SUBPIXEL_BITS) + 1, view.size.xy);
  if (twiceArea == 0.0 || any(greaterThanEqual(low, high))) return;
  bool clockwise = twiceArea < 0.0;
  dvec2 pixel = 2.0 / dvec2(view.size.xy);
  dvec2 placeOfA = (dvec2(a) / double(1 << SUBPIXEL_BITS) + 0.5) * pixel - 1.0;
  dmat3 placeFromA = dmat3(dvec3(placeOfA, 1.0), dvec3(pixel.x, 0.0, 0.0), dvec3(0.0, pixel.y, 0.0));
  dmat3 weights = weightsFromPlace * placeFromA;
  ivec4 corners[5];
  for (int i = 0; i < 5; ++i) {
    int j = clockwise ? count - 2 * i : 2 * i;
    corners[i] = ivec4(polygon[clamp(clockwise && i == 0 ? 0 : j, 0, 8)].snapped, polygon[clamp(clockwise ? j - 1 : j + 1, 0, 8)].snapped);
  }
  for (int i = 0; i < 4; ++i) {
    ivec2 far = clockwise ? ivec2(i >> 1, i & 1) : ivec2(i & 1, i >> 1);
    gl_Position = vec4(dvec2(low + (high - low) * far) * pixel - 1.0, 0.0, 1.0);
    gl_PrimitiveID = gl_PrimitiveIDIn;
    coveringCorners = corners;
    coveringCount = count;
    interpolate(weights);
    EmitVertex();
  }
}

// Bits of the planes that a vertex is outside of.
int crossedPlanes() {
  int planes = 0;
  for (int plane = 0; plane < 6; ++plane) {
    vec3 distances = vec3(inside(gl_in[0].gl_Position, plane), inside(gl_in[1].gl_Position, plane),
                          inside(gl_in[2].gl_Position, plane));
    if (any(lessThan(distances, vec3(0.0)))) planes |= 1 << plane;
  }
  return planes;
}

void main() {
  Corner polygon[MAX_CORNERS];
  int count = 3;
  for (int i = 0; i < 3; ++i) polygon[i] = vertexCorner(gl_in[i].gl_Position);
  for (int planes = crossedPlanes(); planes != 0; planes &= planes - 1)
    count = clipped(polygon, count, findLSB(planes));
  dmat3 clipFromWeights = dmat3(gl_in[0].gl_Position.xyw, gl_in[1].gl_Position.xyw, gl_in[2].gl_Position.xyw);
  // From a place in normalised device coordinates (Olano and Greer 1997); of what only rounding gives an area, the first
  // vertex's alone.
  dmat3 weights = dmat3(dvec3(0.0), dvec3(0.0), dvec3(1.0 / double(gl_in[0].gl_Position.w), 0.0, 0.0));
  if (determinant(clipFromWeights) != 0.0) weights = inverse(clipFromWeights);
  emitRectangle(polygon, count, weights);
}
