#include "scene/deformation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace sfumato::scene {
namespace {

void expectNear(const glm::dvec3& actual, const glm::dvec3& expected) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(actual[c], expected[c], 1e-6) << "component " << c;
}

// (0,0,0) (1,0,0) (0,1,0), facing +Z.
Mesh triangle() {
  Mesh mesh;
  mesh.vertices.resize(3);
  mesh.vertices[1].position = {1, 0, 0};
  mesh.vertices[2].position = {0, 1, 0};
  mesh.indices = {0, 1, 2};
  return mesh;
}

glm::dvec3 facing(const Mesh& mesh) {
  const auto p = [&](size_t k) { return glm::dvec3(mesh.vertices[mesh.indices[k]].position); };
  return glm::normalize(glm::cross(p(1) - p(0), p(2) - p(0)));
}

std::vector<Influences> allFollow(uint32_t joint) {
  Influences influences;
  influences.joints[0] = joint;
  influences.weights[0] = 1;
  return std::vector<Influences>(3, influences);
}

TEST(Deformation, MorphAddsToPositionsNormalsAndTangents) {
  Mesh mesh = triangle();
  std::vector<MorphOffset> offsets(3);
  offsets[1] = {.position = {1, 2, 3}, .normal = {1, 0, 0}, .tangent = {0, 1, 0}};
  offsets[2].normal = {0, 0, -1};  // nothing is left
  mesh.vertices[1].tangent.w = -1;
  morph(mesh, offsets);
  expectNear(mesh.vertices[0].position, {0, 0, 0});
  expectNear(mesh.vertices[1].position, {2, 2, 3});
  expectNear(mesh.vertices[1].normal, glm::normalize(glm::dvec3(1, 0, 1)));
  expectNear(mesh.vertices[1].tangent, glm::normalize(glm::dvec3(1, 1, 0)));
  EXPECT_EQ(mesh.vertices[1].tangent.w, -1);
  expectNear(mesh.vertices[2].normal, {0, 0, 0});
}

TEST(Deformation, SkinTakesTheWeightedMeanOfItsJoints) {
  Mesh mesh = triangle();
  const glm::dmat4 joints[] = {glm::translate(glm::dmat4(1), {4, 0, 0}),
                               glm::translate(glm::dmat4(1), {0, 8, 0})};
  std::vector<Influences> influences = allFollow(0);
  influences[1].joints = {1, 0};
  influences[1].weights = {0.25f, 0.75f};
  influences[2].joints[7] = 1;
  influences[2].weights = {0, 0, 0, 0, 0, 0, 0, 1};
  skin(mesh, influences, joints);
  expectNear(mesh.vertices[0].position, {4, 0, 0});
  expectNear(mesh.vertices[1].position, {1 + 3, 2, 0});
  expectNear(mesh.vertices[2].position, {0, 9, 0});
}

TEST(Deformation, SkinTurnsNormalsAsSurfacesAndTangentsAsEdges) {
  Mesh mesh = triangle();
  for (Vertex& v : mesh.vertices) {
    v.normal = glm::normalize(glm::vec3(1, 0, 1));
    v.tangent = glm::vec4(glm::normalize(glm::vec3(1, 0, -1)), -1);
  }
  const glm::dmat4 stretch[] = {glm::scale(glm::dmat4(1), {2, 1, 1})};
  skin(mesh, allFollow(0), stretch);
  expectNear(mesh.vertices[0].normal, glm::normalize(glm::dvec3(0.5, 0, 1)));
  expectNear(mesh.vertices[0].tangent, glm::normalize(glm::dvec3(2, 0, -1)));
  EXPECT_EQ(mesh.vertices[0].tangent.w, -1);
  EXPECT_EQ(mesh.indices, (std::vector<uint32_t>{0, 1, 2}));
}

TEST(Deformation, MirroringJointsKeepFrontFacesAndBitangents) {
  Mesh mesh = triangle();
  const glm::dmat4 mirror[] = {glm::scale(glm::dmat4(1), {-1, 1, 1})};
  skin(mesh, allFollow(0), mirror);
  expectNear(mesh.vertices[0].normal, {0, 0, 1});
  expectNear(facing(mesh), {0, 0, 1});
  const Vertex& v = mesh.vertices[0];
  expectNear(v.tangent, {-1, 0, 0});
  expectNear(glm::cross(v.normal, glm::vec3(v.tangent)) * v.tangent.w, {0, 1, 0});  // mirrored +Y
}

TEST(Deformation, FlatJointsLeaveNoNaN) {
  Mesh mesh = triangle();
  const glm::dmat4 flat[] = {glm::scale(glm::dmat4(1), {0, 0, 0})};
  skin(mesh, allFollow(0), flat);
  for (const Vertex& v : mesh.vertices) {
    expectNear(v.position, {0, 0, 0});
    expectNear(v.normal, {0, 0, 0});
  }
}

}  // namespace
}  // namespace sfumato::scene
