// Triangles that rays can be asked for, in double precision: a bounding volume hierarchy with the watertight
// test of Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection" (JCGT 2013). For the reference only.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

namespace sfumato::pipelines {

struct Ray {
  glm::dvec3 origin{0.0};
  glm::dvec3 direction{0, 0, -1};  // unit

  glm::dvec3 at(double t) const { return origin + t * direction; }
};

struct Box {
  glm::dvec3 low{std::numeric_limits<double>::infinity()};
  glm::dvec3 high{-std::numeric_limits<double>::infinity()};

  bool empty() const { return !(low.x <= high.x); }
  void add(const glm::dvec3& p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
};

using Triangle = std::array<glm::dvec3, 3>;

struct Hit {
  double t = 0;
  uint32_t triangle = 0;    // index in the triangles given
  glm::dvec3 weights{0.0};  // barycentric, of the triangle's corners
};

class Bvh {
 public:
  // Triangles with a corner that is not finite are never hit.
  explicit Bvh(std::vector<Triangle> triangles);

  // Called with a hit, gives the farthest t still of interest (or less than tMin: no more).
  using Visit = std::function<double(const Hit&)>;

  // Visits the hits with tMin <= t <= tMax, each triangle at most once and from either side, in no order of
  // t. A ray through the edge or corner that triangles share behaves as a ray beside it would: it crosses a
  // surface made of them once, and never slips through.
  void forEachHit(const Ray& ray, double tMin, double tMax, const Visit& visit) const;

  const Triangle& triangle(uint32_t index) const { return triangles_[index]; }
  const Box& bounds() const { return bounds_; }

 private:
  struct Node {
    Box box;
    uint32_t begin = 0;       // leaf: its range in order_
    uint32_t end = 0;         // 0: an inner node, whose first child is the next node
    uint32_t otherChild = 0;  // inner node: its second child
  };

  void build(uint32_t begin, uint32_t end);

  std::vector<Triangle> triangles_;
  std::vector<uint32_t> order_;
  std::vector<Node> nodes_;
  Box bounds_;
};

}  // namespace sfumato::pipelines
