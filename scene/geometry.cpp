#include "scene/geometry.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace sfumato::scene {
namespace {

using glm::dvec3;

glm::dvec3 unitOr(const dvec3& v, const dvec3& otherwise) {
  const double length = glm::length(v);
  return length > 0 ? v / length : otherwise;
}

// Some unit vector at a right angle to the unit vector n.
dvec3 across(const dvec3& n) {
  const dvec3 axis = std::abs(n.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
  return glm::normalize(axis - n * glm::dot(n, axis));
}

// Twice the area, along the normal.
dvec3 areaVector(const Vertex& a, const Vertex& b, const Vertex& c) {
  const dvec3 p(a.position);
  return glm::cross(dvec3(b.position) - p, dvec3(c.position) - p);
}

void setTangent(Vertex& vertex, const dvec3& tangent, float handedness) {
  vertex.tangent = glm::vec4(unitOr(tangent, across(vertex.normal)), handedness);
}

double cornerAngle(const dvec3& at, const dvec3& next, const dvec3& last) {
  const dvec3 a = next - at, b = last - at;
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

glm::dvec2 textureCoordinates(const Vertex& vertex, const TextureUse& use) {
  return glm::dmat3x2(use.textureFromUv) * glm::dvec3(use.uvSet == 0 ? vertex.uv0 : vertex.uv1, 1);
}

// One triangle's dP/du, unit, and whether its texture is mirrored; valid false where that has no meaning.
struct TextureFrame {
  dvec3 tangent{0.0};
  bool mirrored = false;
  bool valid = false;
};

TextureFrame textureFrame(const Vertex& a, const Vertex& b, const Vertex& c, const TextureUse& use) {
  const dvec3 edge1 = dvec3(b.position) - dvec3(a.position), edge2 = dvec3(c.position) - dvec3(a.position);
  const glm::dvec2 uv = textureCoordinates(a, use);
  const glm::dvec2 uv1 = textureCoordinates(b, use) - uv, uv2 = textureCoordinates(c, use) - uv;
  const double area = uv1.x * uv2.y - uv2.x * uv1.y;
  const dvec3 tangent = unitOr((edge1 * uv2.y - edge2 * uv1.y) * (area < 0 ? -1.0 : 1.0), dvec3(0.0));
  // v points down in glTF, so a texture that is not mirrored has a negative area on a front face.
  return {tangent, area > 0, area != 0 && tangent != dvec3(0.0)};
}

// Sums of tangents at one vertex, for triangles with unmirrored [0] and mirrored [1] texture.
struct TangentSums {
  dvec3 sum[2] = {dvec3(0.0), dvec3(0.0)};
  bool used[2] = {false, false};
};

}  // namespace

std::vector<uint32_t> trianglesOfStrip(std::span<const uint32_t> strip) {
  std::vector<uint32_t> triangles;
  for (size_t i = 0; i + 2 < strip.size(); ++i) {
    const size_t odd = i % 2;
    triangles.insert(triangles.end(), {strip[i], strip[i + 1 + odd], strip[i + 2 - odd]});
  }
  return triangles;
}

std::vector<uint32_t> trianglesOfFan(std::span<const uint32_t> fan) {
  std::vector<uint32_t> triangles;
  for (size_t i = 0; i + 2 < fan.size(); ++i)
    triangles.insert(triangles.end(), {fan[i + 1], fan[i + 2], fan[0]});
  return triangles;
}

void makeFlat(Mesh& mesh) {
  std::vector<Vertex> corners;
  corners.reserve(mesh.indices.size());
  for (uint32_t index : mesh.indices) corners.push_back(mesh.vertices[index]);
  for (size_t i = 0; i + 2 < corners.size(); i += 3) {
    const dvec3 normal = unitOr(areaVector(corners[i], corners[i + 1], corners[i + 2]), dvec3(0, 0, 1));
    for (size_t corner = i; corner < i + 3; ++corner) corners[corner].normal = normal;
  }
  mesh.vertices = std::move(corners);
  for (size_t i = 0; i < mesh.indices.size(); ++i) mesh.indices[i] = static_cast<uint32_t>(i);
}

void normaliseNormals(Mesh& mesh) {
  bool anyZero = false;
  for (Vertex& vertex : mesh.vertices) {
    vertex.normal = unitOr(vertex.normal, dvec3(0.0));
    anyZero = anyZero || vertex.normal == glm::vec3(0.f);
  }
  if (!anyZero) return;
  for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    Vertex* corners[3];
    for (size_t k = 0; k < 3; ++k) corners[k] = &mesh.vertices[mesh.indices[i + k]];
    const dvec3 normal = unitOr(areaVector(*corners[0], *corners[1], *corners[2]), dvec3(0.0));
    for (Vertex* corner : corners)
      if (corner->normal == glm::vec3(0.f)) corner->normal = normal;
  }
  for (Vertex& vertex : mesh.vertices)
    if (vertex.normal == glm::vec3(0.f)) vertex.normal = {0.f, 0.f, 1.f};
}

void normaliseTangents(Mesh& mesh) {
  for (Vertex& vertex : mesh.vertices)
    setTangent(vertex, dvec3(vertex.tangent), vertex.tangent.w < 0 ? -1.f : 1.f);
}

void computeTangents(Mesh& mesh, const TextureUse& use) {
  std::vector<TangentSums> sums(mesh.vertices.size());
  const size_t triangles = mesh.indices.size() / 3;
  std::vector<TextureFrame> frames(triangles);
  for (size_t t = 0; t < triangles; ++t) {
    const uint32_t* indices = &mesh.indices[3 * t];
    const auto vertex = [&](size_t k) -> const Vertex& { return mesh.vertices[indices[k % 3]]; };
    frames[t] = textureFrame(vertex(0), vertex(1), vertex(2), use);
    if (!frames[t].valid) continue;
    const int side = frames[t].mirrored;
    for (size_t k = 0; k < 3; ++k) {
      const dvec3 normal(vertex(k).normal);
      const dvec3 inPlane = frames[t].tangent - normal * glm::dot(normal, frames[t].tangent);
      const double angle = cornerAngle(vertex(k).position, vertex(k + 1).position, vertex(k + 2).position);
      sums[indices[k]].sum[side] += angle * unitOr(inPlane, dvec3(0.0));
      sums[indices[k]].used[side] = true;
    }
  }

  // Where both kinds meet, the mirrored one gets a copy of the vertex.
  std::vector<uint32_t> mirroredVertex(sums.size());
  for (size_t v = 0; v < sums.size(); ++v) {
    const bool onlyMirrored = sums[v].used[1] && !sums[v].used[0];
    mirroredVertex[v] = static_cast<uint32_t>(v);
    if (sums[v].used[0] && sums[v].used[1]) {
      mirroredVertex[v] = static_cast<uint32_t>(mesh.vertices.size());
      mesh.vertices.push_back(mesh.vertices[v]);
      setTangent(mesh.vertices.back(), sums[v].sum[1], -1.f);
    }
    setTangent(mesh.vertices[v], sums[v].sum[onlyMirrored], onlyMirrored ? -1.f : 1.f);
  }
  for (size_t t = 0; t < triangles; ++t)
    if (frames[t].valid && frames[t].mirrored)
      for (size_t k = 0; k < 3; ++k) mesh.indices[3 * t + k] = mirroredVertex[mesh.indices[3 * t + k]];
}

Mesh mirrored(const Mesh& mesh) {
  Mesh copy = mesh;
  for (size_t i = 0; i + 2 < copy.indices.size(); i += 3) std::swap(copy.indices[i + 1], copy.indices[i + 2]);
  for (Vertex& vertex : copy.vertices) vertex.tangent.w = -vertex.tangent.w;
  return copy;
}

Mesh transformed(const Mesh& mesh, const glm::dmat4& transform) {
  const glm::dmat3 linear(transform);
  // Columns of the cofactor matrix: how area vectors go.
  const glm::dmat3 areas(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                         glm::cross(linear[0], linear[1]));
  Mesh copy = mesh;
  for (Vertex& vertex : copy.vertices) {
    vertex.position = glm::dvec3(transform * glm::dvec4(vertex.position, 1.0));
    vertex.normal = unitOr(areas * dvec3(vertex.normal), dvec3(0.0));
    vertex.tangent = glm::vec4(linear * dvec3(vertex.tangent), vertex.tangent.w);
  }
  normaliseNormals(copy);
  normaliseTangents(copy);
  return copy;
}

}  // namespace sfumato::scene
