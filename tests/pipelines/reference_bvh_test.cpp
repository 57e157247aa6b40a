#include "pipelines/reference_bvh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/random.h"
#include "tests/pipelines/known_scenes.h"

namespace sfumato::pipelines {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::vector<Triangle> trianglesOf(const scene::Mesh& mesh) {
  std::vector<Triangle> triangles;
  const auto corner = [&](size_t i) { return glm::dvec3(mesh.vertices[mesh.indices[i]].position); };
  for (size_t i = 0; i < mesh.indices.size(); i += 3)
    triangles.push_back({corner(i), corner(i + 1), corner(i + 2)});
  return triangles;
}

std::vector<Hit> hitsOf(const Bvh& bvh, const Ray& ray, double tMin = 0, double tMax = infinity) {
  std::vector<Hit> hits;
  bvh.forEachHit(ray, tMin, tMax, [&](const Hit& hit) {
    hits.push_back(hit);
    return tMax;
  });
  std::ranges::sort(hits, {}, [](const Hit& hit) { return std::pair(hit.t, hit.triangle); });
  return hits;
}

glm::dvec3 randomPoint(base::Random& random) {
  return {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
}

// Solves origin + t d = a + u (b - a) + v (c - a) by Cramer's rule.
std::vector<double> bruteForce(const std::vector<Triangle>& triangles, const Ray& ray) {
  std::vector<double> found;
  for (const Triangle& p : triangles) {
    const glm::dvec3 e1 = p[1] - p[0];
    const glm::dvec3 e2 = p[2] - p[0];
    const glm::dvec3 s = ray.origin - p[0];
    const double determinant = glm::determinant(glm::dmat3(-ray.direction, e1, e2));
    const double t = glm::determinant(glm::dmat3(s, e1, e2)) / determinant;
    const double u = glm::determinant(glm::dmat3(-ray.direction, s, e2)) / determinant;
    const double v = glm::determinant(glm::dmat3(-ray.direction, e1, s)) / determinant;
    if (u > 0 && v > 0 && u + v < 1 && t >= 0) found.push_back(t);
  }
  std::ranges::sort(found);
  return found;
}

TEST(ReferenceBvh, FindsWhatTryingAllTrianglesFinds) {
  base::Random random(7);
  std::vector<Triangle> triangles;
  for (int i = 0; i < 500; ++i) {
    const glm::dvec3 centre = randomPoint(random);
    triangles.push_back({centre + 0.3 * randomPoint(random), centre + 0.3 * randomPoint(random),
                         centre + 0.3 * randomPoint(random)});
  }
  const Bvh bvh(triangles);
  size_t total = 0;
  for (int i = 0; i < 2000; ++i) {
    const Ray ray{2.0 * randomPoint(random), glm::normalize(randomPoint(random))};
    const std::vector<double> expected = bruteForce(triangles, ray);
    const std::vector<Hit> hits = hitsOf(bvh, ray);
    ASSERT_EQ(hits.size(), expected.size());
    total += hits.size();
    for (size_t k = 0; k < hits.size(); ++k) {
      EXPECT_NEAR(hits[k].t, expected[k], 1e-9);  // grazing hits magnify rounding
      const Triangle& p = triangles[hits[k].triangle];
      const glm::dvec3 w = hits[k].weights;
      EXPECT_LT(glm::distance(ray.at(hits[k].t), w.x * p[0] + w.y * p[1] + w.z * p[2]), 1e-9);
    }
  }
  EXPECT_GT(total, 1000u);
}

TEST(ReferenceBvh, KeepsToTheRange) {
  const Bvh bvh(trianglesOf(tests::box({-1, -1, -1}, {1, 1, 1})));
  const Ray ray{{0.25, 0.125, 4}, {0, 0, -1}};
  ASSERT_EQ(hitsOf(bvh, ray).size(), 2u);
  EXPECT_DOUBLE_EQ(hitsOf(bvh, ray)[0].t, 3);
  EXPECT_DOUBLE_EQ(hitsOf(bvh, ray)[1].t, 5);
  EXPECT_EQ(hitsOf(bvh, ray, 3.5, 10).size(), 1u);
  EXPECT_EQ(hitsOf(bvh, ray, 0, 3).size(), 1u) << "both ends count";
  EXPECT_EQ(hitsOf(bvh, ray, 3.5, 4.5).size(), 0u);
}

TEST(ReferenceBvh, StopsWhenToldTo) {
  std::vector<Triangle> stack;
  for (int i = 0; i < 100; ++i)
    stack.push_back({glm::dvec3(-1, -1, -i), glm::dvec3(3, -1, -i), glm::dvec3(-1, 3, -i)});
  const Bvh bvh(stack);
  int visits = 0;
  bvh.forEachHit({{0, 0, 1}, {0, 0, -1}}, 0, infinity, [&](const Hit&) {
    ++visits;
    return -infinity;
  });
  EXPECT_EQ(visits, 1);
}

// Through every corner, along every edge and diagonal of a tiled plane: one hit each, neither none nor two.
TEST(ReferenceBvh, APlaneOfTilesIsHitOnceEverywhere) {
  const int n = 8;
  const Bvh bvh(trianglesOf(tests::tiledQuad({-4, -4, 0}, {8, 0, 0}, {0, 8, 0}, n)));
  for (int y = -4 * n + 4; y < 4 * n - 3; ++y)
    for (int x = -4 * n + 4; x < 4 * n - 3; ++x) {
      const glm::dvec3 target(x / 8.0, y / 8.0, 0);
      EXPECT_EQ(hitsOf(bvh, {target + glm::dvec3(0, 0, 3), {0, 0, -1}}).size(), 1u);
      const glm::dvec3 eye(0.3, -7.1, 11.7);
      EXPECT_EQ(hitsOf(bvh, {eye, glm::normalize(target - eye)}).size(), 1u);
    }
}

// A closed surface is left as often as it is entered, also through its corners and edges and past its
// outline.
TEST(ReferenceBvh, AClosedSurfaceIsCrossedEvenlyFromOutside) {
  const scene::Mesh mesh = tests::sphere(8, 16);
  const std::vector<Triangle> triangles = trianglesOf(mesh);
  const Bvh bvh(triangles);
  base::Random random(3);
  for (int i = 0; i < 200; ++i) {
    const glm::dvec3 eye = 3.0 * glm::normalize(randomPoint(random));
    for (const scene::Vertex& vertex : mesh.vertices) {
      const Ray through{eye, glm::normalize(glm::dvec3(vertex.position) - eye)};
      EXPECT_EQ(hitsOf(bvh, through).size() % 2, 0u);
    }
  }
  for (const scene::Vertex& vertex : mesh.vertices) {  // along the axes, exactly through corners
    const glm::dvec3 p(vertex.position);
    EXPECT_EQ(hitsOf(bvh, {{p.x, p.y, 5}, {0, 0, -1}}).size() % 2, 0u);
    EXPECT_EQ(hitsOf(bvh, {{p.x, 5, p.z}, {0, -1, 0}}).size() % 2, 0u);
    EXPECT_EQ(hitsOf(bvh, {{-5, p.y, p.z}, {1, 0, 0}}).size() % 2, 0u);
  }
  for (const Triangle& p : triangles)
    EXPECT_EQ(hitsOf(bvh, {glm::dvec3(0), glm::normalize(p[0] + p[1])}).size(), 1u) << "from inside";
}

TEST(ReferenceBvh, TakesWhatIsDegenerate) {
  const glm::dvec3 p(0, 0, 0);
  const glm::dvec3 bad(std::nan(""), 0, infinity);
  const Bvh bvh({{p, p, p}, {bad, p, glm::dvec3(1, 0, 0)}, {p, glm::dvec3(1, 0, 0), glm::dvec3(2, 0, 0)}});
  EXPECT_TRUE(hitsOf(bvh, {{0, 0, 1}, {0, 0, -1}}).empty());
  EXPECT_TRUE(hitsOf(Bvh({}), {{0, 0, 1}, {0, 0, -1}}).empty());
  EXPECT_TRUE(Bvh({}).bounds().empty());
}

}  // namespace
}  // namespace sfumato::pipelines
