// The scenes of comparisons: as many triangles as were asked for, the same on every run, and what they are
// said to show.
#include "scene/generated_scenes.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "pipelines/reference.h"
#include "scene/surface.h"

namespace sfumato::scene {
namespace {

using glm::dvec3;

constexpr double aspect = 16.0 / 9;

size_t triangleCount(const Mesh& mesh) {
  return mesh.indices.size() / 3;
}

dvec3 cross(const Mesh& mesh, size_t triangle) {
  const auto p = [&](size_t i) { return dvec3(mesh.vertices[mesh.indices[3 * triangle + i]].position); };
  return glm::cross(p(1) - p(0), p(2) - p(0));
}

TEST(Surface, HasAsManyTrianglesAsWereAskedFor) {
  const auto square = [](double u, double v) { return dvec3(u, v, 0); };
  for (size_t triangles = 2; triangles < 300; ++triangles)
    for (const double shape : {0.1, 1.0, 7.0})
      EXPECT_EQ(triangleCount(tessellated(square, triangles, shape)), triangles);
}

// Then there is no gap and nothing lies over another: all triangles look the same way, and their areas are
// the square's.
TEST(Surface, CoversASquareOnce) {
  for (const size_t triangles : {2u, 3u, 7u, 100u, 1001u, 4999u}) {
    const Mesh mesh = tessellated([](double u, double v) { return dvec3(u, v, 0); }, triangles, 2);
    double area = 0;
    for (size_t i = 0; i < triangleCount(mesh); ++i) {
      EXPECT_GT(cross(mesh, i).z, 0) << i;
      area += 0.5 * cross(mesh, i).z;
    }
    EXPECT_NEAR(area, 1, 1e-5) << triangles;
    for (const Vertex& vertex : mesh.vertices) EXPECT_NEAR(vertex.normal.z, 1, 1e-5);
  }
}

// Of a tube, whose ends meet: inner edges have two triangles, those of the rims one.
TEST(Surface, LeavesNoEdgeOpenButItsRims) {
  const auto tube = [](double u, double v) {
    const double angle = 2 * std::numbers::pi * (u - std::floor(u));
    return dvec3(std::cos(angle), v, std::sin(angle));
  };
  for (const size_t triangles : {200u, 333u, 1001u}) {
    const Mesh mesh = tessellated(tube, triangles, 3);
    std::map<std::set<std::array<float, 3>>, int> edges;
    const auto place = [&](uint32_t i) {
      const glm::vec3& p = mesh.vertices[i].position;
      return std::array<float, 3>{p.x, p.y, p.z};
    };
    for (size_t i = 0; i < mesh.indices.size(); ++i) {
      const size_t next = i % 3 == 2 ? i - 2 : i + 1;
      ++edges[{place(mesh.indices[i]), place(mesh.indices[next])}];
    }
    for (const auto& [edge, count] : edges) {
      const bool rim = edge.begin()->at(1) == edge.rbegin()->at(1) &&
                       (edge.begin()->at(1) == 0.f || edge.begin()->at(1) == 1.f);
      EXPECT_EQ(count, rim ? 1 : 2);
    }
  }
}

void expectCounts(const Scene& scene, const TriangleCounts& wanted) {
  TriangleCounts counts;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
    const bool translucent = scene.materials[static_cast<size_t>(mesh.material)].translucent();
    (translucent ? counts.translucent : counts.opaque) += triangleCount(mesh);
  }
  EXPECT_EQ(counts.opaque, wanted.opaque);
  EXPECT_EQ(counts.translucent, wanted.translucent);
}

TEST(GeneratedScenes, HaveTheTrianglesOfThePapers) {
  for (const TriangleCounts& counts :
       {TriangleCounts{38812, 20832}, TriangleCounts{49210, 10434}, TriangleCounts{59644, 0}})
    expectCounts(hallScene(counts, 4, aspect).scene, counts);
  expectCounts(courtScene({263353, 24000}, aspect).scene, {263353, 24000});
  expectCounts(statueScene({201075, 0}, aspect).scene, {201075, 0});
  expectCounts(houseScene({10563, 1000}, aspect).scene, {10563, 1000});
  expectCounts(withoutTranslucent(houseScene({10563, 1000}, aspect).scene), {10563, 0});
}

TEST(GeneratedScenes, AreOneSceneWhateverTheNumberOfLights) {
  const Scene few = hallScene({38812, 20832}, 2, aspect).scene;
  const Scene many = hallScene({38812, 20832}, mostHallLights, aspect).scene;
  ASSERT_EQ(few.lights.size(), 2u);
  ASSERT_EQ(many.lights.size(), 64u);
  for (size_t i = 0; i < few.lights.size(); ++i) {
    EXPECT_EQ(few.lights[i].position, many.lights[i].position);
    EXPECT_EQ(few.lights[i].direction, many.lights[i].direction);
  }
  for (const Light& light : many.lights) EXPECT_EQ(light.type, LightType::Spot);
  ASSERT_EQ(few.meshes.size(), many.meshes.size());
  for (size_t i = 0; i < few.meshes.size(); ++i) EXPECT_EQ(few.meshes[i].indices, many.meshes[i].indices);
}

TEST(GeneratedScenes, AreTheSameOnEveryRun) {
  const GeneratedScene a = layersScene(aspect, 24), b = layersScene(aspect, 24);
  EXPECT_EQ(a.media[0].grid.values, b.media[0].grid.values);
  const Scene courts[] = {courtScene({20001, 1003}, aspect).scene, courtScene({20001, 1003}, aspect).scene};
  for (size_t i = 0; i < courts[0].meshes.size(); ++i) {
    const auto &left = courts[0].meshes[i].vertices, &right = courts[1].meshes[i].vertices;
    ASSERT_EQ(left.size(), right.size());
    for (size_t k = 0; k < left.size(); ++k) EXPECT_EQ(left[k].position, right[k].position);
  }
}

TEST(GeneratedScenes, HoldFiniteUnitNormals) {
  for (const GeneratedScene& made :
       {layersScene(aspect, 16), hallScene({5000, 1500}, 1, aspect), courtScene({6000, 500}, aspect),
        statueScene({5000, 300}, aspect), houseScene({5001, 301}, aspect)})
    for (const Mesh& mesh : made.scene.meshes)
      for (const Vertex& vertex : mesh.vertices) {
        EXPECT_NEAR(glm::length(vertex.normal), 1, 1e-4) << mesh.name;
        EXPECT_NEAR(glm::length(glm::vec3(vertex.tangent)), 1, 1e-4) << mesh.name;
      }
}

// By the reference, which counts the translucent surfaces before each pixel.
TEST(GeneratedScenes, ShowEveryNumberOfLayersAndSmoke) {
  GeneratedScene made = layersScene(aspect, 24);
  made.scene.lights.clear();  // for the counting alone
  const pipelines::ReferenceFrame frame = pipelines::traceReference(
      made.scene, made.scene.cameras[0], made.media,
      {.width = 128, .height = 72, .aovs = {pipelines::Aov::Fragments, pipelines::Aov::Transmittance}});
  std::map<int, int> pixels;
  for (const float count : frame.aovs.at(pipelines::Aov::Fragments).values) ++pixels[static_cast<int>(count)];
  for (int layers = 0; layers <= 8; ++layers) EXPECT_GT(pixels[layers], 15) << layers;
  EXPECT_EQ(pixels.rbegin()->first, 8);
  const image::Image& transmittance = frame.aovs.at(pipelines::Aov::Transmittance);
  int smoky = 0;
  for (int y = 0; y < 72; ++y)
    for (int x = 0; x < 128; ++x)
      smoky +=
          frame.aovs.at(pipelines::Aov::Fragments).pixel(x, y)[0] == 0 && transmittance.pixel(x, y)[0] < 0.7f;
  EXPECT_GT(smoky, 100);
}

}  // namespace
}  // namespace sfumato::scene
