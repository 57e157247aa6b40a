#include "pipelines/reference_bvh.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace sfumato::pipelines {

namespace {

constexpr uint32_t leafSize = 4;
constexpr double boxMargin = 1e-12;  // of the scene's extent: more than the rounding of a triangle test

bool isFinite(const Triangle& triangle) {
  for (const glm::dvec3& p : triangle)
    if (!std::isfinite(p.x + p.y + p.z)) return false;
  return true;
}

glm::dvec3 centre(const Triangle& triangle) {
  return (triangle[0] + triangle[1] + triangle[2]) / 3.0;
}

// Where the ray enters the box, or nothing.
std::optional<double> enter(const Box& box, const Ray& ray, const glm::dvec3& inverseDirection, double tMin,
                            double tMax) {
  for (int axis = 0; axis < 3; ++axis) {
    const double t0 = (box.low[axis] - ray.origin[axis]) * inverseDirection[axis];
    const double t1 = (box.high[axis] - ray.origin[axis]) * inverseDirection[axis];
    tMin = std::max(tMin, std::min(t0, t1));
    tMax = std::min(tMax, std::max(t0, t1));
  }
  // The margin of the boxes covers rounding across the ray; along it the far end is moved out.
  return tMin <= tMax + 1e-14 * std::abs(tMax) ? std::optional(tMin) : std::nullopt;
}

// A ray in which space is sheared so that the ray runs along one axis.
class ShearedRay {
 public:
  explicit ShearedRay(const Ray& ray) : origin_(ray.origin) {
    const glm::dvec3 size = glm::abs(ray.direction);
    along_ = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
    const double length = ray.direction[along_];
    shear_ = glm::dvec2(ray.direction[x()], ray.direction[y()]) / length;
    scale_ = 1 / length;
  }

  std::optional<Hit> intersect(const Triangle& triangle, uint32_t index) const {
    const glm::dvec2 a = across(triangle[0]);
    const glm::dvec2 b = across(triangle[1]);
    const glm::dvec2 c = across(triangle[2]);
    const glm::dvec3 areas(areaOf(b, c), areaOf(c, a), areaOf(a, b));
    const bool left = isLeft(areas.x, b, c);
    if (isLeft(areas.y, c, a) != left || isLeft(areas.z, a, b) != left) return {};
    const double sum = areas.x + areas.y + areas.z;
    if (sum == 0) return {};
    const glm::dvec3 weights = areas / sum;
    return Hit{glm::dot(weights, {along(triangle[0]), along(triangle[1]), along(triangle[2])}), index,
               weights};
  }

 private:
  int x() const { return (along_ + 1) % 3; }
  int y() const { return (along_ + 2) % 3; }

  glm::dvec2 across(const glm::dvec3& p) const {
    const glm::dvec3 q = p - origin_;
    return glm::dvec2(q[x()], q[y()]) - shear_ * q[along_];
  }
  double along(const glm::dvec3& p) const { return (p[along_] - origin_[along_]) * scale_; }

  // Twice the signed area between the ray and the edge a→b; exactly the negative for b→a, whatever the
  // compiler contracts, since the ends are taken in one order.
  static double areaOf(const glm::dvec2& a, const glm::dvec2& b) {
    const bool ordered = a.x < b.x || (a.x == b.x && a.y <= b.y);
    return ordered ? cross(a, b) : -cross(b, a);
  }
  static double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

  // Whether the ray passes left of a→b. One through the edge counts as moved by (e, e * e) for a tiny e > 0.
  static bool isLeft(double area, const glm::dvec2& a, const glm::dvec2& b) {
    if (area != 0) return area > 0;
    return a.y != b.y ? b.y < a.y : b.x > a.x;
  }

  glm::dvec3 origin_;
  int along_ = 0;
  glm::dvec2 shear_{0.0};
  double scale_ = 1;
};

}  // namespace

Bvh::Bvh(std::vector<Triangle> triangles) : triangles_(std::move(triangles)) {
  for (uint32_t index = 0; index < triangles_.size(); ++index) {
    if (!isFinite(triangles_[index])) continue;
    order_.push_back(index);
    for (const glm::dvec3& p : triangles_[index]) bounds_.add(p);
  }
  if (!order_.empty()) build(0, static_cast<uint32_t>(order_.size()));
}

void Bvh::build(uint32_t begin, uint32_t end) {
  const size_t index = nodes_.size();
  nodes_.emplace_back();
  Box box;
  Box centres;
  for (uint32_t i = begin; i < end; ++i) {
    for (const glm::dvec3& p : triangles_[order_[i]]) box.add(p);
    centres.add(centre(triangles_[order_[i]]));
  }
  const double margin = boxMargin * (glm::length(bounds_.high - bounds_.low) + glm::length(bounds_.low));
  nodes_[index].box = {box.low - margin, box.high + margin};
  if (end - begin <= leafSize) {
    nodes_[index].begin = begin;
    nodes_[index].end = end;
    return;
  }

  const glm::dvec3 extent = centres.high - centres.low;
  const int axis = extent.x >= extent.y ? (extent.x >= extent.z ? 0 : 2) : (extent.y >= extent.z ? 1 : 2);
  const uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(
      order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
      [&](uint32_t a, uint32_t b) { return centre(triangles_[a])[axis] < centre(triangles_[b])[axis]; });
  build(begin, middle);
  nodes_[index].otherChild = static_cast<uint32_t>(nodes_.size());
  build(middle, end);
}

void Bvh::forEachHit(const Ray& ray, double tMin, double tMax, const Visit& visit) const {
  if (nodes_.empty()) return;
  const ShearedRay sheared(ray);
  const glm::dvec3 inverseDirection = 1.0 / ray.direction;
  std::array<uint32_t, 64> open;  // halving leaves fewer than 32 levels
  size_t count = 0;
  open[count++] = 0;
  while (count > 0 && tMin <= tMax) {
    const uint32_t index = open[--count];
    const Node& node = nodes_[index];
    if (!enter(node.box, ray, inverseDirection, tMin, tMax)) continue;
    if (node.end == 0) {
      open[count++] = node.otherChild;
      open[count++] = index + 1;
      continue;
    }
    for (uint32_t i = node.begin; i < node.end; ++i) {
      const std::optional<Hit> hit = sheared.intersect(triangles_[order_[i]], order_[i]);
      if (hit && hit->t >= tMin && hit->t <= tMax) tMax = std::min(tMax, visit(*hit));
    }
  }
}

}  // namespace sfumato::pipelines
