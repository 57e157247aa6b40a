// The viewport cut into triangles that share their edges: CELLS x CELLS quads with their corners moved at random (and convex still), each
// cut along one diagonal or the other; or (FAN) a fan of CELLS slivers a side around a point.
#include "shaders/shared/hash.glsl"

#if defined(MUTANT_SWOLLEN) && !defined(SWOLLEN)
#define SWOLLEN
#endif

vec2 latticePoint(uvec2 at) {
  uint chance = hash(at.y * (CELLS + 1u) + at.x + SEED);
  vec2 shift = (vec2(chance & 0xffffu, chance >> 16) / 65536.0 - 0.5) * 0.4;
  if (at.x == 0u || at.x == CELLS) shift.x = 0.0;
  if (at.y == 0u || at.y == CELLS) shift.y = 0.0;
  return (vec2(at) + shift) / float(CELLS) * 2.0 - 1.0;
}

// Around the viewport, `at` in [0, 4 CELLS].
vec2 borderPoint(uint at) {
  uint side = at / CELLS % 4u;
  float along = float(at % CELLS) / float(CELLS) * 2.0 - 1.0;
  return side == 0u ? vec2(along, -1.0) : side == 1u ? vec2(1.0, along) : side == 2u ? vec2(-along, 1.0) : vec2(-1.0, -along);
}

vec2 corner(uint triangle, uint index) {
#ifdef FAN
  return index == 0u ? vec2(0.137, -0.071) : borderPoint(triangle + index - 1u);
#else
  uint cell = triangle / 2u;
  uvec2 at = uvec2(cell % CELLS, cell / CELLS);
  bool other = (hash(cell + SEED * 7u) & 1u) != 0u;
  // The four corners in turn; a triangle leaves one out.
  uint left = triangle % 2u * 2u + (other ? 1u : 0u);
  uint around = (left + 1u + index) % 4u;
  return latticePoint(at + uvec2(around == 1u || around == 2u ? 1u : 0u, around >= 2u ? 1u : 0u));
#endif
}

void main() {
  uint triangle = uint(gl_VertexID) / 3u;
  vec2 position = corner(triangle, uint(gl_VertexID) % 3u);
#ifdef SWOLLEN
  vec2 middle = (corner(triangle, 0u) + corner(triangle, 1u) + corner(triangle, 2u)) / 3.0;
  position = middle + (position - middle) * 1.25;
#endif
  gl_Position = vec4(position, 0.0, 1.0);
}
