// Draws triangles so that they cover all samples of the pixels whose centres they cover, with multisampling switched on: a
// geometry shader puts a rectangle of whole pixels in place of each, and a fragment asks isCovered() (scene/covered.glsl)
// whether it is in the triangle. The viewport is that of the whole image.
//
// These are to be the very pixels at which the driver makes fragments of the triangle, so it is clipped, projected and
// rounded as Mesa's software drivers do it (gallium's draw module and llvmpipe's setup).
#include "shaders/scene/covered_polygon.glsl"
#include "shaders/shared/view_block.glsl"

layout(triangles) in;
layout(triangle_strip, max_vertices = 4) out;

// Of what clipping leaves of the triangle, two in each vector.
flat out ivec4 coveringCorners[5];
flat out int coveringCount;

// Hands on what is to be interpolated: x and y pixels from the first corner the sum of the vertices' values times
// weights * (1, x, y) is the value divided by w; the sum of these weights is 1 / w.
void interpolate(dmat3 weights);

struct Corner {
  vec4 clip;
  ivec2 snapped;
};

// What is left of the triangle: each of the six planes of the view volume adds one corner at most.
#define MAX_CORNERS 9
Corner polygon[MAX_CORNERS];
int count = 3;
bool clockwise = false;

int cornerCount() {
  return count;
}

// The first one is the first in either direction.
ivec2 corner(int i) {
  return i < count ? polygon[clockwise && i > 0 ? count - i : i].snapped : ivec2(0);
}

ivec2 snapped(vec2 window) {
  return ivec2(roundEven((window - 0.5) * float(1 << SUBPIXEL_BITS)));
}

// A vertex: scaled and moved with one rounding, which doubles imitate.
Corner vertexCorner(vec4 clip) {
  precise float inverseW = 1.0 / clip.w;
  precise vec2 ndc = clip.xy * inverseW;
  dvec2 halfSize = dvec2(view.size.xy) * 0.5;
  return Corner(clip, snapped(vec2(dvec2(ndc) * halfSize + halfSize)));
}

// What clipping puts between two corners: each operation rounds.
Corner cutCorner(vec4 from, vec4 to, float t) {
  precise vec4 clip = from + t * (to - from);
  precise float inverseW = 1.0 / clip.w;
  vec2 halfSize = vec2(view.size.xy) * 0.5;
  precise vec2 window = clip.xy * inverseW * halfSize + halfSize;
  return Corner(clip, snapped(window));
}

// How far inside a plane: right, left, top, bottom, near, far.
float inside(vec4 clip, int plane) {
  bool lower = plane == 1 || plane == 3 || plane == 4;
  float at = clip[plane >> 1];
  return clip.w + (lower ? at : -at);
}

// Bits of the planes that a vertex is outside of.
int crossedPlanes() {
  int planes = 0;
  for (int plane = 0; plane < 6; ++plane)
    for (int i = 0; i < 3; ++i)
      if (inside(gl_in[i].gl_Position, plane) < 0.0) planes |= 1 << plane;
  return planes;
}

// Keeps what is inside a plane. New corners are told from the nearer old one, or else the one inside.
void clipPolygon(int plane) {
  Corner kept[MAX_CORNERS];
  int keptCount = 0;
  for (int i = 0; i < count; ++i) {
    Corner a = polygon[i];
    Corner b = polygon[i + 1 < count ? i + 1 : 0];
    float insideA = inside(a.clip, plane);
    float insideB = inside(b.clip, plane);
    if (insideA >= 0.0) kept[keptCount++] = a;
    if ((insideA < 0.0) != (insideB < 0.0)) {
      bool fromB = abs(insideB) < abs(insideA) || (insideB == -insideA && insideB > 0.0);
      kept[keptCount++] = fromB ? cutCorner(b.clip, a.clip, insideB / (insideB - insideA))
                                : cutCorner(a.clip, b.clip, insideA / (insideA - insideB));
    }
  }
  polygon = kept;
  count = keptCount;
}

// Twice the area, positive where corners go round counter-clockwise.
double area() {
  double sum = 0.0;
  for (int i = 2; i < count; ++i) {
    dvec2 a = dvec2(polygon[i - 1].snapped - polygon[0].snapped);
    dvec2 b = dvec2(polygon[i].snapped - polygon[0].snapped);
    sum += a.x * b.y - a.y * b.x;
  }
  return sum;
}

// The vertices' weights from (x, y, 1) in normalised device coordinates (Olano and Greer 1997, section 3). Where only
// rounding gives the triangle an area, it looks like its first vertex all over.
dmat3 weightsFromPlace() {
  dmat3 clipFromWeights = dmat3(gl_in[0].gl_Position.xyw, gl_in[1].gl_Position.xyw, gl_in[2].gl_Position.xyw);
  double firstAlone = 1.0 / double(gl_in[0].gl_Position.w);
  return determinant(clipFromWeights) != 0.0 ? inverse(clipFromWeights)
                                             : dmat3(dvec3(0.0), dvec3(0.0), dvec3(firstAlone, 0.0, 0.0));
}

// The rectangle of the pixels from low to before high. It winds as the polygon does, so that culling is what it was.
void emitRectangle(ivec2 low, ivec2 high) {
  dvec2 pixel = 2.0 / dvec2(view.size.xy);
  dvec2 first = (dvec2(polygon[0].snapped) / double(1 << SUBPIXEL_BITS) + 0.5) * pixel - 1.0;
  dmat3 placeFromFirst = dmat3(dvec3(first, 1.0), dvec3(pixel.x, 0.0, 0.0), dvec3(0.0, pixel.y, 0.0));
  dmat3 weights = weightsFromPlace() * placeFromFirst;
  for (int i = 0; i < 4; ++i) {
    ivec2 far = clockwise ? ivec2(i >> 1, i & 1) : ivec2(i & 1, i >> 1);
    gl_Position = vec4(dvec2(low + (high - low) * far) * pixel - 1.0, 0.0, 1.0);
    gl_PrimitiveID = gl_PrimitiveIDIn;
    for (int j = 0; j < 5; ++j) coveringCorners[j] = ivec4(corner(2 * j), corner(2 * j + 1));
    coveringCount = count;
    interpolate(weights);
    EmitVertex();
  }
}

void main() {
  for (int i = 0; i < 3; ++i) polygon[i] = vertexCorner(gl_in[i].gl_Position);
  for (int planes = crossedPlanes(); planes != 0; planes &= planes - 1) clipPolygon(findLSB(planes));
  ivec2 low = polygon[0].snapped;
  ivec2 high = low;
  for (int i = 1; i < count; ++i) {
    low = min(low, polygon[i].snapped);
    high = max(high, polygon[i].snapped);
  }
  // Pixels whose centres may be in the polygon.
  low = max(low + (1 << SUBPIXEL_BITS) - 1 >> SUBPIXEL_BITS, ivec2(0));
  high = min((high >> SUBPIXEL_BITS) + 1, view.size.xy);
  double twiceArea = area();
  if (twiceArea == 0.0 || any(greaterThanEqual(low, high))) return;
  clockwise = twiceArea < 0.0;
  bool onePixel = high - low == ivec2(1);
  if (!onePixel || isCovered(low)) emitRectangle(low, high);
}
