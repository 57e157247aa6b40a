#include "scene/surface.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.h"

namespace sfumato::scene {
namespace {

Vertex vertexOf(const SurfacePoint& point, double u, double v) {
  constexpr double step = 1e-4;
  const glm::dvec3 alongU = point(u + step, v) - point(u - step, v);
  const glm::dvec3 alongV = point(u, v + step) - point(u, v - step);
  const glm::dvec3 normal = glm::cross(alongU, alongV);
  Vertex vertex;
  vertex.position = point(u, v);
  if (glm::length(normal) > 0) vertex.normal = glm::normalize(normal);
  if (glm::length(alongU) > 0) vertex.tangent = glm::vec4(glm::normalize(alongU), 1);
  vertex.uv0 = vertex.uv1 = {u, v};
  return vertex;
}

// Segments of each row of vertices. A strip has as many triangles as both its rows have segments, so that the
// first and the last row count once and the others twice.
std::vector<size_t> segmentsOf(size_t triangles, double aspect) {
  const double wanted = std::sqrt(static_cast<double>(triangles) / (2 * aspect));
  const size_t strips = std::clamp<size_t>(std::llround(wanted), 1, triangles / 2);
  std::vector<size_t> segments(strips + 1, triangles / (2 * strips));
  const size_t left = triangles % (2 * strips);
  segments.front() += left % 2;
  for (size_t row = 1; row <= left / 2; ++row) ++segments[row];
  return segments;
}

// The strip between two rows; of both, the vertex that is less far along u comes next.
void addStrip(Mesh& mesh, uint32_t lower, size_t lowerSegments, uint32_t upper, size_t upperSegments) {
  for (size_t i = 0, j = 0; i < lowerSegments || j < upperSegments;) {
    const bool alongLower =
        j == upperSegments || (i < lowerSegments && (i + 1) * upperSegments <= (j + 1) * lowerSegments);
    const auto a = static_cast<uint32_t>(lower + i), b = static_cast<uint32_t>(upper + j);
    mesh.indices.insert(mesh.indices.end(), {a, alongLower ? a + 1 : b + 1, b});
    ++(alongLower ? i : j);
  }
}

}  // namespace

Mesh tessellated(const SurfacePoint& point, size_t triangles, double aspect) {
  base::check(triangles >= 2, "a surface has two triangles at least");
  const std::vector<size_t> segments = segmentsOf(triangles, aspect);
  Mesh mesh;
  uint32_t below = 0;
  for (size_t row = 0; row < segments.size(); ++row) {
    const auto first = static_cast<uint32_t>(mesh.vertices.size());
    const double v = static_cast<double>(row) / static_cast<double>(segments.size() - 1);
    for (size_t i = 0; i <= segments[row]; ++i)
      mesh.vertices.push_back(
          vertexOf(point, static_cast<double>(i) / static_cast<double>(segments[row]), v));
    if (row > 0) addStrip(mesh, below, segments[row - 1], first, segments[row]);
    below = first;
  }
  return mesh;
}

}  // namespace sfumato::scene
