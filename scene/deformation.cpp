#include "scene/deformation.h"

#include <utility>

namespace sfumato::scene {
namespace {

using glm::dvec3;

dvec3 unitOrZero(const dvec3& v) {
  const double length = glm::length(v);
  return length > 0 ? v / length : dvec3(0.0);
}

glm::dmat4 mean(const Influences& influences, std::span<const glm::dmat4> matrices) {
  glm::dmat4 sum(0.0);
  for (size_t i = 0; i < influences.joints.size(); ++i)
    if (influences.weights[i] > 0)
      sum += static_cast<double>(influences.weights[i]) * matrices[influences.joints[i]];
  return sum;
}

}  // namespace

void morph(Mesh& mesh, std::span<const MorphOffset> offsets) {
  for (size_t i = 0; i < mesh.vertices.size(); ++i) {
    Vertex& v = mesh.vertices[i];
    v.position = dvec3(v.position) + offsets[i].position;
    v.normal = unitOrZero(dvec3(v.normal) + offsets[i].normal);
    v.tangent = glm::vec4(unitOrZero(dvec3(v.tangent) + offsets[i].tangent), v.tangent.w);
  }
}

void skin(Mesh& mesh, std::span<const Influences> influences, std::span<const glm::dmat4> worldFromRest) {
  size_t mirrored = 0;
  for (size_t i = 0; i < mesh.vertices.size(); ++i) {
    Vertex& v = mesh.vertices[i];
    const glm::dmat4 matrix = mean(influences[i], worldFromRest);
    const glm::dmat3 linear(matrix);
    const double side = glm::determinant(linear) < 0 ? -1 : 1;
    // The inverse transpose but for its length, which a flat matrix has as well.
    const glm::dmat3 forNormals(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                                glm::cross(linear[0], linear[1]));
    v.position = dvec3(matrix * glm::dvec4(v.position, 1));
    v.normal = unitOrZero(side * (forNormals * dvec3(v.normal)));
    v.tangent = glm::dvec4(unitOrZero(linear * dvec3(v.tangent)), side * v.tangent.w);
    mirrored += side < 0;
  }
  if (2 * mirrored <= mesh.vertices.size()) return;
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
}

}  // namespace sfumato::scene
