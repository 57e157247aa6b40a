#include "scene/default_set.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "image/metrics.h"
#include "pipelines/reference.h"
#include "volumes/procedural_smoke.h"

namespace sfumato::scene {
namespace {

using glm::dvec3;

constexpr double yfov = 0.7;

const std::vector<Bounds>& boxes() {
  static const std::vector<Bounds> all = {
      {dvec3(-1), dvec3(1)},           {{0, 0, 0}, {1, 50, 1}},      {{0, 0, 0}, {400, 1, 300}},
      {dvec3(1e-4), dvec3(3e-4)},      {dvec3(0), dvec3(1e5)},       {dvec3(1e6), dvec3(1e6 + 1)},
      {{-5, -900, 7}, {-4, -899, 20}}, {{0, 0, 0}, {1e-3, 1, 1e-3}},
  };
  return all;
}

// Where the picture has a point: -1 to 1 across it, and its depth.
dvec3 projected(const Camera& camera, double aspect, const dvec3& pWorld) {
  const dvec3 p(glm::inverse(camera.worldFromView) * glm::dvec4(pWorld, 1));
  const double y = -p.z * std::tan(camera.yfov / 2);
  return {p.x / (y * aspect), p.y / y, -p.z};
}

TEST(FramingCamera, SeesTheWholeBoxAndFillsThePicture) {
  for (const Bounds& box : boxes())
    for (const double aspect : {0.25, 1.0, 16.0 / 9, 4.0}) {
      const Camera camera = framingCamera(box, yfov, aspect);
      double widest = 0;
      for (int i = 0; i < 8; ++i) {
        const dvec3 corner(i & 1 ? box.low.x : box.high.x, i & 2 ? box.low.y : box.high.y,
                           i & 4 ? box.low.z : box.high.z);
        const dvec3 p = projected(camera, aspect, corner);
        EXPECT_GT(p.z, camera.nearDistance);
        widest = std::max({widest, std::abs(p.x), std::abs(p.y)});
      }
      EXPECT_LT(widest, 0.95);
      EXPECT_GT(widest, 0.8);
    }
}

TEST(FramingCamera, StandsSomewhereForNoBoxAtAll) {
  for (const Bounds& box : {Bounds{}, Bounds{dvec3(3), dvec3(3)}}) {
    const Camera camera = framingCamera(box, yfov, 1);
    for (int column = 0; column < 4; ++column)
      for (int row = 0; row < 4; ++row) EXPECT_TRUE(std::isfinite(camera.worldFromView[column][row]));
  }
}

TEST(DefaultSet, HasGroundBelowTwoLightsAndACamera) {
  for (const Bounds& box : boxes()) {
    Scene scene;
    addDefaultSet(scene, box, yfov, 1.5);
    ASSERT_EQ(scene.cameras.size(), 1u);
    ASSERT_EQ(scene.lights.size(), 2u);
    for (const Light& light : scene.lights) {
      EXPECT_EQ(light.type, LightType::Directional);
      EXPECT_NEAR(glm::length(light.direction), 1, 1e-12);
      EXPECT_LT(light.direction.y, 0);
    }
    ASSERT_EQ(scene.instances.size(), 1u);
    const Mesh& ground = scene.meshes[0];
    double highest = -infinity;  // of the ground under the box
    for (const Vertex& vertex : ground.vertices) {
      const dvec3 p(scene.instances[0].worldFromObject * glm::dvec4(dvec3(vertex.position), 1));
      if (p.z >= box.low.z) highest = std::max(highest, p.y);
    }
    EXPECT_LT(highest, box.low.y);
    EXPECT_GT(highest, box.low.y - 0.05 * box.radius());
  }
}

TEST(DefaultSet, LightsCanBeHadAlone) {
  Scene scene;
  addDefaultLights(scene);
  ASSERT_EQ(scene.lights.size(), 2u);
  EXPECT_TRUE(scene.instances.empty());
  for (const Light& light : scene.lights) {
    EXPECT_EQ(light.type, LightType::Directional);
    EXPECT_NEAR(glm::length(light.direction), 1, 1e-12);
    EXPECT_LT(light.direction.y, 0);
    EXPECT_LT(light.direction.z, 0);  // onto what the framing camera sees
  }
}

TEST(DefaultSet, KeepsWhatTheSceneHas) {
  Scene scene;
  scene.materials.resize(2);
  scene.meshes.resize(3);
  addDefaultSet(scene, boxes()[0], yfov, 1);
  EXPECT_EQ(scene.instances[0].mesh, 3);
  EXPECT_EQ(scene.meshes[3].material, 2);
}

// The triangles face what their normals say.
TEST(DefaultSet, GroundFacesTheCamera) {
  Scene scene;
  addDefaultSet(scene, boxes()[0], yfov, 1);
  const Mesh& ground = scene.meshes[0];
  for (size_t i = 0; i < ground.indices.size(); i += 3) {
    const Vertex& a = ground.vertices[ground.indices[i]];
    const Vertex& b = ground.vertices[ground.indices[i + 1]];
    const Vertex& c = ground.vertices[ground.indices[i + 2]];
    const glm::vec3 normal = glm::normalize(glm::cross(b.position - a.position, c.position - a.position));
    for (const Vertex* vertex : {&a, &b, &c}) {
      EXPECT_GT(glm::dot(normal, vertex->normal), 0.99);
      EXPECT_NEAR(glm::length(vertex->normal), 1, 1e-6);
    }
  }
}

volumes::Medium filledBox(const glm::ivec3& voxels, float density, double voxelSize) {
  volumes::Medium medium;
  medium.grid.size = voxels;
  medium.grid.values.assign(static_cast<size_t>(voxels.x * voxels.y * voxels.z), density);
  medium.worldFromIndex = glm::scale(glm::dmat4(1), dvec3(voxelSize));
  return medium;
}

TEST(FittingScale, GivesTheOpticalDepthThroughAUniformCube) {
  for (const float density : {1e-3f, 1.f, 500.f})
    for (const double voxel : {1e-3, 1.0, 1e3}) {
      const volumes::Medium cube = filledBox(glm::ivec3(10), density, voxel);
      EXPECT_NEAR(fittingScale(cube) * density * voxel * 10 / fittingOpticalDepth, 1, 1e-6);
    }
}

TEST(FittingScale, IsGeometricOverTheAxes) {
  // Depths along the axes: 4, 16 and 2, whose geometric mean is (128)^(1/3).
  EXPECT_NEAR(fittingScale(filledBox({4, 16, 2}, 1, 1)), fittingOpticalDepth / std::cbrt(128.0), 1e-9);
}

TEST(FittingScale, LooksAtTheDensestPart) {
  // One column of eleven in each direction of the plane is ten times as dense: it is the densest tenth.
  volumes::Medium medium = filledBox({19, 1, 1}, 1, 1);
  medium.grid.values[7] = 10;
  // Along x: 28. Along y and z: the two densest of 19 columns, 10 and 1, mean 5.5.
  EXPECT_NEAR(fittingScale(medium), fittingOpticalDepth / std::cbrt(28 * 5.5 * 5.5), 1e-9);
}

TEST(FittingScale, OfNothingIsOne) {
  EXPECT_EQ(fittingScale(filledBox(glm::ivec3(3), 0, 1)), 1);
  EXPECT_EQ(fittingScale(volumes::Medium{}), 1);
}

// The picture is the same whatever the size and place of the smoke.
TEST(DefaultSet, LooksTheSameAtAnySizeAndPlace) {
  const volumes::DensityGrid plume = volumes::makePlume(16, 1, 3);
  const auto picture = [&](double scale, const dvec3& offset) {
    std::vector<volumes::Medium> media(1);
    media[0].grid = plume;
    media[0].worldFromIndex =
        glm::scale(glm::translate(glm::dmat4(1), offset), dvec3(scale)) * plume.worldFromIndex;
    media[0].scale = fittingScale(media[0]);
    Scene scene;
    addDefaultSet(scene, boundsOf(media), yfov, 1.5);
    return pipelines::renderReference(scene, scene.cameras[0], media, {.width = 24, .height = 16});
  };
  const image::Image expected = picture(1, dvec3(0));
  double brightest = 0;
  for (const float value : expected.values) brightest = std::max<double>(brightest, value);
  EXPECT_GT(brightest, 0.3);
  EXPECT_LT(brightest, 2);
  EXPECT_LT(image::compare(picture(1e-3, dvec3(0)), expected).relativeRmse, 1e-3);
  EXPECT_LT(image::compare(picture(1e4, dvec3(0)), expected).relativeRmse, 1e-3);
  EXPECT_LT(image::compare(picture(1, dvec3(1e5, -3e4, 2e5)), expected).relativeRmse, 1e-3);
}

}  // namespace
}  // namespace sfumato::scene
