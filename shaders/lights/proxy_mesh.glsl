// Meshes around what lights reach, PROXY_VERTICES each, made from the vertex number: an icosahedron around a sphere, a
// pyramid of eight sides around a cone. Faces turn outwards.
#include "shaders/lights/proxy.glsl"

const float GOLDEN = 1.61803398875;
// Circumradius over inradius of the icosahedron, and of an octagon, rounded up.
const float ICOSAHEDRON_EXCESS = 1.2585;
const float OCTAGON_EXCESS = 1.0825;

const vec3 CORNERS[12] = vec3[](vec3(-1, GOLDEN, 0), vec3(1, GOLDEN, 0), vec3(-1, -GOLDEN, 0), vec3(1, -GOLDEN, 0),
                                vec3(0, -1, GOLDEN), vec3(0, 1, GOLDEN), vec3(0, -1, -GOLDEN), vec3(0, 1, -GOLDEN),
                                vec3(GOLDEN, 0, -1), vec3(GOLDEN, 0, 1), vec3(-GOLDEN, 0, -1), vec3(-GOLDEN, 0, 1));
const int FACES[60] = int[](0, 11, 5, 0, 5, 1, 0, 1, 7, 0, 7, 10, 0, 10, 11, 1, 5, 9, 5, 11, 4, 11, 10, 2, 10, 7, 6, 7, 1, 8,
                            3, 9, 4, 3, 4, 2, 3, 2, 6, 3, 6, 8, 3, 8, 9, 4, 9, 5, 2, 4, 11, 6, 2, 10, 8, 6, 7, 9, 8, 1);

vec3 sphereVertex(int vertex, Proxy proxy) {
  return proxy.centre + normalize(CORNERS[FACES[vertex]]) * (proxy.radius * ICOSAHEDRON_EXCESS);
}

// Apex, eight base corners, and the base's middle; 16 triangles, the rest of the 60 vertices degenerate.
vec3 coneVertex(int vertex, Proxy proxy) {
  int triangle = min(vertex / 3, 15);
  int corner = vertex / 48 > 0 ? 0 : vertex % 3;
  float height = proxy.radius + length(proxy.apex - proxy.centre);
  vec3 side = normalize(abs(proxy.axis.x) < 0.7 ? cross(proxy.axis, vec3(1, 0, 0)) : cross(proxy.axis, vec3(0, 1, 0)));
  vec3 up = cross(proxy.axis, side);
  vec3 middle = proxy.apex + proxy.axis * height;
  bool base = triangle >= 8;
  if (corner == 0) return base ? middle : proxy.apex;
  // Sides and base turn opposite ways, so that both face outwards.
  int step = base ? corner - 1 : 2 - corner;
  float angle = float(triangle % 8 + step) * (PI / 4.0);
  float radius = height * proxy.tangent * OCTAGON_EXCESS;
  return middle + radius * (cos(angle) * side + sin(angle) * up);
}

// Of view space.
vec3 proxyVertex(int vertex, Proxy proxy) {
  return proxy.isCone ? coneVertex(vertex, proxy) : sphereVertex(vertex, proxy);
}
