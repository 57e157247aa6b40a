// The volume that a point or spot light reaches, in view space, inflated by how far a ray through a cell can be off the
// ray through its centre: every point that the light reaches inside the cell, moved at its depth onto the centre ray,
// is inside the inflated volume. That makes lists conservative, whatever they are built by.
#include "shaders/shared/lights.h"
#include "shaders/shared/math.glsl"
#include "shaders/shared/view.h"

struct Proxy {
  vec3 centre;   // of the sphere
  float radius;
  bool isCone;
  vec3 apex;     // of the cone, moved back
  vec3 axis;
  float cosine;  // of its half angle
  float sine;
  float tangent;
};

const float WIDEST_CONE_COSINE = 0.5;  // wider spots are treated as spheres

// Everything within `off` of the proxy. A cone moved back by off / sin holds what is within `off` of it.
Proxy inflated(Proxy proxy, float off) {
  proxy.radius += off;
  proxy.apex -= proxy.axis * (off / max(proxy.sine, 1e-4));
  return proxy;
}

// Holds, for every point of the proxy that a ray through a square of `pixels` a side meets, the point of that depth on the
// ray through the square's middle.
Proxy seenInSquare(Proxy proxy, float pixels, ViewParams camera) {
  vec2 pixel = 2.0 * camera.halfExtent.xy / vec2(camera.size.xy);
  float off = 0.505 * pixels * length(pixel);  // half the diagonal at depth 1, or anywhere, with a little for rounding
  if (camera.halfExtent.z == 0.0) off *= max(-proxy.centre.z + proxy.radius, 0.0);
  return inflated(proxy, off);
}

// What a light reaches, with a little for rounding.
Proxy lightProxy(uint number, ViewParams camera) {
  LightData light = lightAt(number);
  Proxy proxy;
  proxy.centre = (camera.viewFromWorld * vec4(light.position.xyz, 1.0)).xyz;
  proxy.radius = light.position.w;
  proxy.axis = mat3(camera.viewFromWorld) * light.direction.xyz;
  proxy.apex = proxy.centre;
  proxy.cosine = light.direction.w;
  proxy.sine = light.cone.z;
  proxy.tangent = light.cone.w;
  proxy.isCone = light.indices.x == LIGHT_SPOT && proxy.cosine > WIDEST_CONE_COSINE;
  return inflated(proxy, 1e-5 * (proxy.radius + length(proxy.centre)));
}

// Depths at which start + depth * perDepth is inside the sphere; false when nowhere.
bool sphereRange(Proxy proxy, vec3 start, vec3 perDepth, out vec2 range) {
  vec3 from = start - proxy.centre;
  float a = dot(perDepth, perDepth);
  float b = dot(from, perDepth);
  // The discriminant by the distance of the ray from the centre, which does not cancel for far or large spheres.
  vec3 offAxis = from - perDepth * (b / a);
  float inside = proxy.radius * proxy.radius - dot(offAxis, offAxis);
  if (inside < 0.0) return false;
  float half_ = sqrt(inside / a);
  range = vec2(-b / a - half_, -b / a + half_);
  return true;
}

// The same for the solid cone (one nappe, without end).
bool coneRange(Proxy proxy, vec3 start, vec3 perDepth, out vec2 range) {
  vec3 from = start - proxy.apex;
  float c2 = proxy.cosine * proxy.cosine;
  float dAxis = dot(perDepth, proxy.axis);
  float fAxis = dot(from, proxy.axis);
  // Inside: (x . axis)^2 >= c2 x . x and x . axis >= 0, for x = from + depth * perDepth.
  float a = dAxis * dAxis - c2 * dot(perDepth, perDepth);
  float b = dAxis * fAxis - c2 * dot(perDepth, from);
  float c = fAxis * fAxis - c2 * dot(from, from);
  float root = b * b - a * c;
  if (root < 0.0) {
    // The line misses the double cone's surface: it is all inside (a > 0) or all outside.
    range = vec2(-3e38, 3e38);
    return a > 0.0 && fAxis >= 0.0;
  }
  root = sqrt(root);
  float q = b >= 0.0 ? -(b + root) : root - b;
  float x1 = q / (abs(a) < 1e-20 ? 1e-20 : a);
  float x2 = c / (abs(q) < 1e-20 ? 1e-20 : q);
  vec2 hits = vec2(min(x1, x2), max(x1, x2));
  bool firstAhead = fAxis + hits.x * dAxis >= 0.0;
  bool secondAhead = fAxis + hits.y * dAxis >= 0.0;
  if (a < 0.0) {
    // Inside between the hits, on one nappe.
    range = hits;
    return firstAhead || secondAhead;
  }
  // Inside beyond the hits; the right nappe is the one that the ray runs into.
  range = dAxis > 0.0 ? vec2(secondAhead ? (firstAhead ? -3e38 : hits.y) : 3e38, 3e38)
                      : vec2(-3e38, firstAhead ? (secondAhead ? 3e38 : hits.x) : -3e38);
  return range.x < range.y;
}

// Front and back depth of the light along the ray, cut to what the camera sees; false when it does not meet it.
bool proxyRange(Proxy proxy, vec3 start, vec3 perDepth, vec2 depthRange, out vec2 range) {
  if (!sphereRange(proxy, start, perDepth, range)) return false;
  if (proxy.isCone) {
    vec2 cone;
    if (!coneRange(proxy, start, perDepth, cone)) return false;
    range = vec2(max(range.x, cone.x), min(range.y, cone.y));
  }
  float slack = 1e-4 * (abs(range.y) + proxy.radius);
  range = vec2(max(range.x - slack, 0.0), min(range.y + slack, depthRange.y));
  return range.x <= range.y && range.y >= depthRange.x;
}
