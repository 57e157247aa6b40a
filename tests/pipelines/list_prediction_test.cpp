// What is predicted of lists, where geometry tells the answer.
#include "pipelines/list_prediction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "lists/list_bytes.h"
#include "tests/pipelines/known_scenes.h"

namespace sfumato::pipelines {
namespace {

using glm::dvec3;
using glm::vec3;
using std::numbers::pi;
using tests::add;
using tests::quad;

constexpr int width = 96;
constexpr int height = 64;
constexpr size_t pixels = size_t{width} * height;
constexpr double aspect = 1.5;

scene::Camera orthographic() {
  return tests::orthographicCamera({0, 0, 5}, {0, 0, 0}, 1);  // sees |x| < 1.5, |y| < 1
}

scene::Camera perspective() {
  return tests::perspectiveCamera({0, 0, 5}, {0, 0, 0}, pi / 2);
}

scene::Material film(bool doubleSided = true) {
  scene::Material material = tests::veil({1, 1, 1}, 0.5f);
  material.doubleSided = doubleSided;
  return material;
}

ListPrediction predict(const scene::Scene& scene, const scene::Camera& camera, const Quality& quality = {}) {
  return predictLists(scene, {}, camera, width, height, quality);
}

size_t surfacesOf(scene::Mesh mesh, const scene::Camera& camera, const scene::Material& material = film(),
                  int samples = 1) {
  scene::Scene scene;
  add(scene, std::move(mesh), material);
  return predict(scene, camera, {.samples = samples}).surfaces.nodes;
}

TEST(ListPrediction, OfAQuadThatFillsThePictureIsEveryPixelOnce) {
  const scene::Mesh fitting = quad({-1.5f, -1, 0}, {3, 0, 0}, {0, 2, 0});
  const scene::Mesh larger = quad({-50, -60, 0}, {100, 0, 0}, {0, 120, 0});
  EXPECT_EQ(surfacesOf(fitting, orthographic()), pixels);
  EXPECT_EQ(surfacesOf(larger, orthographic()), pixels);
  EXPECT_EQ(surfacesOf(larger, perspective()), pixels);
  // Of four samples a pixel on the diagonal has two fragments.
  const size_t sampled = surfacesOf(fitting, orthographic(), film(), 4);
  EXPECT_GT(sampled, pixels);
  EXPECT_LT(sampled, pixels + 2 * (width + height));
}

TEST(ListPrediction, IsOfWhatIsInThePicture) {
  EXPECT_EQ(surfacesOf(quad({-9, -9, 0}, {9, 0, 0}, {0, 18, 0}), perspective()), pixels / 2);
  EXPECT_EQ(surfacesOf(quad({-9, -9, 6}, {18, 0, 0}, {0, 18, 0}), perspective()), 0u);  // behind
  EXPECT_EQ(surfacesOf(quad({20, -9, 0}, {18, 0, 0}, {0, 18, 0}), perspective()), 0u);  // beside
  EXPECT_EQ(surfacesOf(quad({-9, -9, 0}, {0, 18, 0}, {0, 0, 9}), orthographic()), 0u);  // edge-on
  EXPECT_EQ(surfacesOf(quad({-9, -9, 5}, {18, 0, 0}, {0, 18, 0}), perspective()), 0u);  // at the eye
  // A floor from far behind the camera to far before it fills the lower half.
  const double floor =
      static_cast<double>(surfacesOf(quad({-2e4f, -1, 1e4f}, {4e4f, 0, 0}, {0, 0, -2e4f}), perspective()));
  EXPECT_NEAR(floor, pixels / 2.0, 0.01 * pixels);
  scene::Camera shortSighted = orthographic();
  shortSighted.farDistance = 4;
  EXPECT_EQ(surfacesOf(quad({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}), shortSighted), 0u);
}

TEST(ListPrediction, IsOfSidesThatAreDrawn) {
  const scene::Mesh away = quad({-9, 9, 0}, {18, 0, 0}, {0, -18, 0});
  EXPECT_EQ(surfacesOf(away, perspective()), pixels);
  EXPECT_EQ(surfacesOf(away, perspective(), film(false)), 0u);
  const scene::Mesh towards = quad({-9, -9, 0}, {18, 0, 0}, {0, 18, 0});
  EXPECT_EQ(surfacesOf(towards, perspective(), film(false)), pixels);
  EXPECT_EQ(surfacesOf(towards, perspective(), tests::veil({1, 1, 1}, 0.f)), 0u);
  EXPECT_EQ(surfacesOf(towards, perspective(), tests::lambert({1, 1, 1})), 0u);
}

TEST(ListPrediction, OfASphereIsItsImage) {
  const double pixelsAcross =
      height / 2.0;  // of a length of 1 in the orthographic picture, at depth 1 in the other
  const double parallel = pi * 0.64 * pixelsAcross * pixelsAcross;
  const double tangent = 1 / std::sqrt(24.0);  // of the angle under which a unit sphere is seen from 5 m
  const double seen = pi * tangent * tangent * pixelsAcross * pixelsAcross;
  for (const int rings : {50, 500}) {  // 10,000 triangles, and a million, of which some are looked at
    scene::Scene scene;
    add(scene, tests::sphere(rings, 2 * rings), film(), glm::dmat4(glm::dmat3(0.8)));
    const double nodes = static_cast<double>(predict(scene, orthographic(), {.samples = 1}).surfaces.nodes);
    EXPECT_NEAR(nodes, 2 * parallel, 0.02 * parallel) << rings;
    // Of the near side only.
    const double front =
        static_cast<double>(surfacesOf(tests::sphere(rings, 2 * rings), perspective(), film(false)));
    EXPECT_NEAR(front, seen, 0.02 * seen) << rings;
  }
}

TEST(ListPrediction, OfManyInstancesIsTheirSum) {
  scene::Scene scene;
  const int one = add(scene, quad({-0.05f, -0.05f, 0}, {0.1f, 0, 0}, {0, 0.1f, 0}), film());
  const scene::Instance instance = scene.instances[static_cast<size_t>(one)];
  for (int i = 1; i < 50000; ++i) {
    scene.instances.push_back(instance);
    scene.instances.back().worldFromObject[3] = glm::dvec4(i % 25 * 0.1 - 1.2, i % 17 * 0.1 - 0.8, 0, 1);
  }
  const double each = 0.01 * height * height / 4.0;
  const double nodes = static_cast<double>(predict(scene, orthographic(), {.samples = 1}).surfaces.nodes);
  EXPECT_NEAR(nodes, 50000 * each, 50 * each);
}

TEST(ListPrediction, OfASunIsTheFaceThatFitsWhatIsSeen) {
  scene::Scene scene;
  add(scene, quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), film());
  scene.lights = {tests::directionalLight({0, 0, -1}, dvec3(1)),
                  tests::directionalLight({0, 0, -1}, dvec3(1))};
  scene.lights[1].castsShadow = false;
  const ListPrediction prediction = predict(scene, orthographic(), {.shadowResolution = 128});
  ASSERT_EQ(prediction.shadows.size(), 2u);
  EXPECT_EQ(prediction.shadows[0].cells, 128u * 128u);
  EXPECT_EQ(prediction.shadows[0].nodes, 124u * 124u);  // all but the margin of two texels
  EXPECT_EQ(prediction.shadows[1].cells, 0u);
  EXPECT_EQ(prediction.shadows[1].nodes, 0u);
}

TEST(ListPrediction, OfALampInABoxIsEveryTexelOfSixFaces) {
  scene::Scene scene;
  add(scene, tests::box({-1, -1, -1}, {1, 1, 1}), film());
  scene.lights = {tests::pointLight({0.2, 0.1, -0.3}, dvec3(1))};
  EXPECT_EQ(predict(scene, perspective(), {.shadowResolution = 128}).shadows[0].nodes, 6u * 64u * 64u);
  // Opaque walls have no lists, unless they do not shadow themselves.
  scene.materials[0] = tests::lambert({1, 1, 1});
  EXPECT_EQ(predict(scene, perspective(), {.shadowResolution = 128}).shadows[0].nodes, 0u);
  scene.materials[0].shadowSelf = false;
  EXPECT_EQ(predict(scene, perspective(), {.shadowResolution = 128}).shadows[0].nodes, 6u * 64u * 64u);
  EXPECT_EQ(predict(scene, perspective(), {.shadowResolution = 128}).surfaces.nodes, 0u);
}

size_t lightNodes(const scene::Light& light, const scene::Camera& camera) {
  scene::Scene scene;
  scene.lights = {light};
  return predict(scene, camera).lights.nodes;
}

TEST(ListPrediction, OfALightIsTheCellsThatItReaches) {
  constexpr size_t cells = (width / 4) * (height / 4);
  scene::Light light = tests::pointLight({0, 0, 0}, dvec3(1));
  light.range = 100;
  EXPECT_EQ(lightNodes(light, perspective()), cells);  // the camera is inside
  light.range = 1;
  light.position = {0, 0, 7};
  EXPECT_EQ(lightNodes(light, perspective()), 0u);  // behind
  light.position = {0, 0, 6.5};
  EXPECT_EQ(lightNodes(light, orthographic()), 0u);
  light.position = {60, 0, 0};
  EXPECT_EQ(lightNodes(light, perspective()), 0u);  // beside
  light.position = {0, 0, 0};
  light.intensity = dvec3(0);
  EXPECT_EQ(lightNodes(light, perspective()), 0u);  // dark

  // A ball of 0.7 m, and by half the diagonal of a cell more.
  light = tests::pointLight({0, 0, 0}, dvec3(1));
  light.range = 0.7;
  const double cell = 4 * 2.0 / height;
  const double radius = 0.7 + cell * std::sqrt(0.5);
  const double expected = pi * radius * radius / (cell * cell);
  EXPECT_NEAR(static_cast<double>(lightNodes(light, orthographic())), expected, 0.05 * expected);
}

TEST(ListPrediction, OfASpotIsItsConeAndNotItsBall) {
  // From the side: a triangle of 3 m and the cap of its ball.
  scene::Light spot = tests::spotLight({-1.5, 0, 0}, {1, 0, 0}, dvec3(1), 0.1, 0.2);
  spot.range = 2.5;
  const double cell = 4 * 2.0 / height;
  const double sector = 0.2 * 2.5 * 2.5 / (cell * cell);
  const double outline = (2 * 2.5 + 0.4 * 2.5) * cell * std::sqrt(0.5) / (cell * cell);
  const double nodes = static_cast<double>(lightNodes(spot, orthographic()));
  EXPECT_GT(nodes, sector);
  EXPECT_LT(nodes, 1.1 * (sector + outline) + 4);
}

TEST(ListPrediction, OfNothingIsNothing) {
  const ListPrediction nothing = predict({}, perspective());
  EXPECT_EQ(nothing.surfaces.nodes, 0u);
  EXPECT_EQ(nothing.surfaces.cells, pixels);
  EXPECT_EQ(nothing.lights.nodes, 0u);
  EXPECT_EQ(nothing.lights.cells, pixels / 16);
  EXPECT_TRUE(nothing.shadows.empty());
  EXPECT_EQ(nothing.allShadows().bytes, 0u);
  scene::Scene noTriangles;
  add(noTriangles, scene::Mesh(), film());
  EXPECT_EQ(predict(noTriangles, perspective()).surfaces.nodes, 0u);
}

TEST(ListPrediction, IsANumberWhateverTheScene) {
  scene::Scene scene;
  const float nan = std::nanf("");
  for (const vec3 corner : {vec3(nan, 0, 0), vec3(INFINITY, 0, 0), vec3(3e38f, -3e38f, 3e38f), vec3(1e-38f)})
    add(scene, quad(corner, {1, 0, 0}, {0, 1, 0}), film());
  add(scene, quad({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}), film());
  scene.lights = {tests::directionalLight({0, -1, 0}, dvec3(1)), tests::pointLight({0, 0, 5}, dvec3(1e30)),
                  tests::spotLight({0, 0, 5}, {0, 0, 0}, dvec3(1e30), 0, 1e-4)};
  const ListPrediction prediction = predict(scene, perspective(), {.samples = 1});
  EXPECT_GE(prediction.surfaces.nodes, pixels);
  EXPECT_LE(prediction.surfaces.nodes, 4 * pixels);
  EXPECT_LE(prediction.lights.nodes, 2 * pixels / 16);
  for (const PredictedLists& shadows : prediction.shadows) EXPECT_LE(shadows.nodes, 8 * shadows.cells);
}

TEST(ListPrediction, TellsBytesOfListsThatAreThereAtOneTime) {
  scene::Scene scene;
  add(scene, quad({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}), film());
  for (const lists::Strategy strategy : {lists::Strategy::Count, lists::Strategy::Append}) {
    Quality quality{.samples = 1};
    quality.lists.strategy = strategy;
    EXPECT_EQ(predict(scene, perspective(), quality).surfaces.bytes,
              lists::bytesOfLists(strategy, pixels, pixels, 40));
  }
  // A large picture is drawn in tiles.
  const ListPrediction large = predictLists(scene, {}, perspective(), 4096, 4096, {.samples = 1});
  EXPECT_EQ(large.surfaces.nodes, size_t{4096} * 4096);
  EXPECT_EQ(large.surfaces.bytes, lists::bytesOfLists(lists::Strategy::Count, 1 << 21, 1 << 21, 40));
}

}  // namespace
}  // namespace sfumato::pipelines
