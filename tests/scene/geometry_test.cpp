#include "scene/geometry.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "scene/printable.h"

namespace sfumato::scene {
namespace {

void expectNear(const glm::vec3& actual, const glm::vec3& expected, float tolerance = 1e-6f) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(actual[c], expected[c], tolerance) << "component " << c;
}

Vertex vertex(glm::vec3 position, glm::vec2 uv = {0, 0}, glm::vec3 normal = {0, 0, 1}) {
  Vertex v;
  v.position = position;
  v.normal = normal;
  v.uv0 = uv;
  return v;
}

// A unit square in the xy plane facing +Z; u to the right, v down as in glTF.
Mesh square() {
  Mesh mesh;
  mesh.vertices = {vertex({0, 0, 0}, {0, 1}), vertex({1, 0, 0}, {1, 1}), vertex({1, 1, 0}, {1, 0}),
                   vertex({0, 1, 0}, {0, 0})};
  mesh.indices = {0, 1, 2, 0, 2, 3};
  return mesh;
}

TEST(Triangles, StripKeepsEachTriangleCounterClockwise) {
  const std::vector<uint32_t> strip = {10, 11, 12, 13, 14};
  EXPECT_EQ(trianglesOfStrip(strip), (std::vector<uint32_t>{10, 11, 12, 11, 13, 12, 12, 13, 14}));
}

TEST(Triangles, FanTurnsAroundItsFirst) {
  const std::vector<uint32_t> fan = {10, 11, 12, 13};
  EXPECT_EQ(trianglesOfFan(fan), (std::vector<uint32_t>{11, 12, 10, 12, 13, 10}));
}

TEST(Triangles, TooFewMakeNone) {
  const std::vector<uint32_t> two = {1, 2};
  EXPECT_TRUE(trianglesOfStrip(two).empty());
  EXPECT_TRUE(trianglesOfFan({}).empty());
}

TEST(MakeFlat, EachTriangleHasItsOwnNormal) {
  Mesh mesh;
  mesh.vertices = {vertex({0, 0, 0}), vertex({1, 0, 0}), vertex({0, 1, 0}), vertex({0, 0, 1})};
  mesh.indices = {0, 1, 2, 0, 2, 3, 0, 1, 1};
  makeFlat(mesh);
  ASSERT_EQ(mesh.vertices.size(), 9u);
  ASSERT_EQ(mesh.indices, (std::vector<uint32_t>{0, 1, 2, 3, 4, 5, 6, 7, 8}));
  for (size_t i = 0; i < 3; ++i) {
    expectNear(mesh.vertices[i].normal, {0, 0, 1});
    expectNear(mesh.vertices[3 + i].normal, {1, 0, 0});
    expectNear(mesh.vertices[6 + i].normal, {0, 0, 1});  // no area
  }
  expectNear(mesh.vertices[5].position, {0, 0, 1});
}

TEST(NormaliseNormals, ZeroTakesTheFace) {
  Mesh mesh;
  mesh.vertices = {vertex({0, 0, 0}, {}, {0, 0, 0}), vertex({0, 1, 0}, {}, {0, 3, 4}),
                   vertex({0, 0, 1}, {}, {1e-20f, 0, 0}), vertex({5, 5, 5}, {}, {0, 0, 0})};
  mesh.indices = {0, 1, 2};
  normaliseNormals(mesh);
  expectNear(mesh.vertices[0].normal, {1, 0, 0});
  expectNear(mesh.vertices[1].normal, {0, 0.6f, 0.8f});
  expectNear(mesh.vertices[2].normal, {1, 0, 0});
  expectNear(mesh.vertices[3].normal, {0, 0, 1});  // in no triangle
}

TEST(ComputeTangents, SquareWithUpright) {
  Mesh mesh = square();
  computeTangents(mesh, {});
  ASSERT_EQ(mesh.vertices.size(), 4u);
  for (const Vertex& v : mesh.vertices) {
    expectNear(v.tangent, {1, 0, 0});
    EXPECT_EQ(v.tangent.w, 1.f);
    expectNear(glm::cross(v.normal, glm::vec3(v.tangent)) * v.tangent.w, {0, 1, 0});  // where v falls
  }
}

TEST(ComputeTangents, MirroredTexture) {
  Mesh mesh = square();
  for (Vertex& v : mesh.vertices) v.uv0.x = 1 - v.uv0.x;
  computeTangents(mesh, {});
  for (const Vertex& v : mesh.vertices) {
    expectNear(v.tangent, {-1, 0, 0});
    EXPECT_EQ(v.tangent.w, -1.f);
    expectNear(glm::cross(v.normal, glm::vec3(v.tangent)) * v.tangent.w, {0, 1, 0});
  }
}

TEST(ComputeTangents, UsesTheSecondUvSet) {
  Mesh mesh = square();
  for (Vertex& v : mesh.vertices) v.uv1 = {1 - v.uv0.y, v.uv0.x};  // turned by a quarter: u runs along +Y
  computeTangents(mesh, {.uvSet = 1});
  for (const Vertex& v : mesh.vertices) {
    expectNear(v.tangent, {0, 1, 0});
    expectNear(glm::cross(v.normal, glm::vec3(v.tangent)) * v.tangent.w, {-1, 0, 0});
  }
}

TEST(ComputeTangents, FollowTheTextureWhereItIsTurned) {
  Mesh mesh = square();
  // u' = 2 v, v' = -u: the texture's u runs along where v falls, its v falls along +X.
  computeTangents(mesh, {.textureFromUv = glm::mat3x2(0, -1, 2, 0, 5, 7)});
  for (const Vertex& v : mesh.vertices) {
    expectNear(v.tangent, {0, -1, 0});
    expectNear(glm::cross(v.normal, glm::vec3(v.tangent)) * v.tangent.w, {1, 0, 0});
  }
}

TEST(ComputeTangents, SeamOfMirroredTextureSplitsVertices) {
  // Two squares side by side whose u runs towards the shared edge from both sides.
  Mesh mesh;
  mesh.vertices = {vertex({-1, 0, 0}, {0, 1}), vertex({0, 0, 0}, {1, 1}), vertex({0, 1, 0}, {1, 0}),
                   vertex({-1, 1, 0}, {0, 0}), vertex({1, 0, 0}, {0, 1}), vertex({1, 1, 0}, {0, 0})};
  mesh.indices = {0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2};
  computeTangents(mesh, {});
  ASSERT_EQ(mesh.vertices.size(), 8u);
  for (size_t i = 0; i < mesh.indices.size(); ++i) {
    const Vertex& v = mesh.vertices[mesh.indices[i]];
    const bool left = i < 6;
    expectNear(v.tangent, {left ? 1 : -1, 0, 0});
    EXPECT_EQ(v.tangent.w, left ? 1.f : -1.f);
  }
  // Positions of the corners are as before.
  expectNear(mesh.vertices[mesh.indices[6]].position, {0, 0, 0});
  expectNear(mesh.vertices[mesh.indices[11]].position, {0, 1, 0});
}

TEST(ComputeTangents, CurvedSurfaceStaysAcrossTheNormal) {
  // A quarter of a cylinder around Y: u runs around it, v down.
  Mesh mesh;
  constexpr int steps = 8;
  for (int i = 0; i <= steps; ++i) {
    const float angle = 1.5707963f * static_cast<float>(i) / steps, u = static_cast<float>(i) / steps;
    const glm::vec3 normal(std::sin(angle), 0, std::cos(angle));
    mesh.vertices.push_back(vertex(normal, {u, 1}, normal));
    mesh.vertices.push_back(vertex(normal + glm::vec3(0, 1, 0), {u, 0}, normal));
  }
  for (uint32_t i = 0; i < steps; ++i) {
    const uint32_t a = 2 * i;
    mesh.indices.insert(mesh.indices.end(), {a, a + 2, a + 3, a, a + 3, a + 1});
  }
  computeTangents(mesh, {});
  for (const Vertex& v : mesh.vertices) {
    expectNear(v.tangent, {v.normal.z, 0, -v.normal.x}, 1e-5f);
    EXPECT_EQ(v.tangent.w, 1.f);
  }
}

TEST(ComputeTangents, WithoutTextureCoordinatesAnyAcross) {
  Mesh mesh = square();
  for (Vertex& v : mesh.vertices) v.uv0 = {0.5f, 0.5f};
  computeTangents(mesh, {});
  ASSERT_EQ(mesh.vertices.size(), 4u);
  for (const Vertex& v : mesh.vertices) {
    EXPECT_NEAR(glm::length(glm::vec3(v.tangent)), 1.f, 1e-6f);
    EXPECT_NEAR(glm::dot(glm::vec3(v.tangent), v.normal), 0.f, 1e-6f);
  }
}

TEST(Mirrored, WindsAndHandsTheOtherWay) {
  const Mesh mesh = mirrored(square());
  EXPECT_EQ(mesh.indices, (std::vector<uint32_t>{0, 2, 1, 0, 3, 2}));
  for (const Vertex& v : mesh.vertices) EXPECT_EQ(v.tangent.w, -1.f);
}

TEST(Transformed, FlatteningTransformKeepsTheFacingNormal) {
  const glm::dmat4 flat = glm::scale(glm::translate(glm::dmat4(1.0), {0, 0, 5}), {2, 3, 0});
  const Mesh mesh = transformed(square(), flat);
  expectNear(mesh.vertices[2].position, {2, 3, 5});
  for (const Vertex& v : mesh.vertices) expectNear(v.normal, {0, 0, 1});
}

TEST(Transformed, NormalsGoAsAreasDo) {
  Mesh mesh = square();
  for (Vertex& v : mesh.vertices) v.normal = glm::normalize(glm::vec3(1, 1, 0));
  const Mesh wide = transformed(mesh, glm::scale(glm::dmat4(1.0), {2, 1, 1}));
  for (const Vertex& v : wide.vertices) expectNear(v.normal, glm::normalize(glm::vec3(0.5f, 1, 0)));
}

TEST(Printable, OneLineOfBoundedLength) {
  EXPECT_EQ(printable("  table \n"), "table");
  EXPECT_EQ(printable("a\nb\x1b[31m\x7f"), "a b [31m");
  EXPECT_EQ(printable("R\xc3\xa4ume"), "R\xc3\xa4ume");
  EXPECT_EQ(printable("1234567890", 4), "1234...");
  EXPECT_EQ(printable("123\xc3\xa4ume", 4), "123...");
  EXPECT_EQ(printable("\t\n"), "");
}

}  // namespace
}  // namespace sfumato::scene
