// Animations, morph targets and skins of glTF files.
#include <gtest/gtest.h>

#include <cmath>

#include "scene/gltf.h"
#include "tests/scene/gltf_builder.h"
#include "tests/scene/gltf_moving.h"

namespace sfumato::scene {
namespace {

using test::GltfBuilder;
using test::Json;
using test::TemporaryFolder;

Scene load(const GltfBuilder& gltf, std::optional<double> seconds = {}) {
  const TemporaryFolder folder("gltf_motion");
  return readGltf(folder.write("scene.gltf", gltf.text()), seconds);
}

void expectNear(const glm::dvec3& actual, const glm::dvec3& expected, double tolerance = 1e-6) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(actual[c], expected[c], tolerance) << "component " << c;
}

// Where a vertex of an instance stands.
glm::dvec3 inWorld(const Scene& scene, size_t instance, size_t vertex) {
  const Instance& at = scene.instances.at(instance);
  const Mesh& mesh = scene.meshes.at(static_cast<size_t>(at.mesh));
  return glm::dvec3(at.worldFromObject * glm::dvec4(mesh.vertices.at(vertex).position, 1));
}

glm::dvec3 normalOf(const Scene& scene, size_t instance, size_t vertex) {
  return scene.meshes.at(static_cast<size_t>(scene.instances.at(instance).mesh)).vertices.at(vertex).normal;
}

// An animation of one property of a node.
void animate(GltfBuilder& gltf, int node, const char* path, const std::vector<float>& times, const char* type,
             const std::vector<float>& values, const char* interpolation = "LINEAR") {
  const int input = gltf.accessor<float>("SCALAR", times);
  const int output = gltf.accessor<float>(type, values);
  gltf.add("animations",
           {{"channels", Json::array({{{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}}})},
            {"samplers",
             Json::array({{{"input", input}, {"output", output}, {"interpolation", interpolation}}})}});
}

// --- Animations ---

TEST(GltfAnimation, PosesTranslationRotationAndScale) {
  GltfBuilder gltf = test::triangle();
  gltf.json["nodes"][0]["translation"] = {7, 7, 7};
  animate(gltf, 0, "translation", {1, 3}, "VEC3", {0, 0, 0, 4, 0, 0});
  animate(gltf, 0, "rotation", {0, 1}, "VEC4", {0, 0, 0, 1, 0, 0, 1, 0});  // half a turn about Z
  animate(gltf, 0, "scale", {0, 1, 2}, "VEC3", {1, 1, 1, 2, 2, 2, 9, 9, 9}, "STEP");
  expectNear(inWorld(load(gltf), 0, 1), {8, 7, 7});
  expectNear(inWorld(load(gltf, 0.5), 0, 1), {0, 1, 0});
  expectNear(inWorld(load(gltf, 1.5), 0, 1), {1 - 2, 0, 0});
  expectNear(inWorld(load(gltf, 100), 0, 1), {4 - 9, 0, 0});
}

TEST(GltfAnimation, CubicSplineAndNormalisedIntegers) {
  GltfBuilder gltf = test::triangle();
  animate(gltf, 0, "translation", {0, 2}, "VEC3", {0, 0, 0, 0, 0, 0, 4, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0},
          "CUBICSPLINE");
  // a = 0, out 4; b = 1, in 0; middle of 2 s: 0.5 + 2 * 4 / 8
  expectNear(inWorld(load(gltf, 1), 0, 0), {1.5, 0, 0});
  const int turns = gltf.accessor<int16_t>("VEC4", {0, 0, 0, 32767, 0, 0, 32767, 0}, true);
  animate(gltf, 0, "rotation", {0, 2}, "VEC4", {0, 0, 0, 0, 0, 0, 0, 0});
  gltf.json["animations"][1]["samplers"][0]["output"] = turns;
  expectNear(inWorld(load(gltf, 1), 0, 1), {1.5, 1, 0});
}

TEST(GltfAnimation, TheLaterOfTwoCounts) {
  GltfBuilder gltf = test::triangle();
  animate(gltf, 0, "translation", {0}, "VEC3", {1, 0, 0});
  animate(gltf, 0, "translation", {0}, "VEC3", {2, 0, 0});
  expectNear(inWorld(load(gltf, 0), 0, 0), {2, 0, 0});
}

TEST(GltfAnimation, CamerasAndLightsMoveAlong) {
  GltfBuilder gltf = test::triangle();
  gltf.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}});
  gltf.light({{"type", "point"}});
  gltf.add("nodes", {{"camera", 0}, {"translation", {0, 1, 0}}});
  gltf.add("nodes", {{"children", {1, 2}}});
  animate(gltf, 3, "translation", {0, 1}, "VEC3", {0, 0, 0, 10, 0, 0});
  const Scene scene = load(gltf, 0.5);
  expectNear(scene.lights.at(0).position, {5, 0, 0});
  expectNear(scene.cameras.at(0).worldFromView[3], {5, 1, 0});
}

TEST(GltfAnimation, LightsTurn) {
  GltfBuilder gltf = test::triangle();
  gltf.light({{"type", "spot"}, {"spot", Json::object()}});
  gltf.light({{"type", "directional"}});
  for (const int node : {1, 2})  // half a turn about Y in a second
    animate(gltf, node, "rotation", {0, 1}, "VEC4", {0, 0, 0, 1, 0, 1, 0, 0});
  for (const auto& [seconds, direction] :
       {std::pair(0.0, glm::dvec3(0, 0, -1)), {0.5, glm::dvec3(-1, 0, 0)}, {1.0, glm::dvec3(0, 0, 1)}})
    for (const Light& light : load(gltf, seconds).lights) expectNear(light.direction, direction);
}

TEST(GltfAnimation, WithoutATimeNothingOfItIsRead) {
  GltfBuilder gltf = test::triangle();
  animate(gltf, 0, "translation", {1, 0}, "VEC3", {1, 0, 0});
  expectNear(inWorld(load(gltf), 0, 1), {1, 0, 0});
}

// --- Morph targets ---

// The triangle with normals, and two targets: one lifts vertex 1 and tips its normal, one moves vertex 2.
GltfBuilder morphed() {
  GltfBuilder gltf = test::triangle();
  Json& primitive = gltf.json["meshes"][0]["primitives"][0];
  primitive["attributes"]["NORMAL"] = gltf.accessor<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
  const int lift = gltf.accessor<float>("VEC3", {0, 0, 0, 0, 0, 2, 0, 0, 0});
  const int tip = gltf.accessor<float>("VEC3", {0, 0, 0, 2, 0, 0, 0, 0, 0});
  const int move = gltf.accessor<float>("VEC3", {0, 0, 0, 0, 0, 0, 0, 4, 0});
  primitive["targets"] = Json::array({{{"POSITION", lift}, {"NORMAL", tip}}, {{"POSITION", move}}});
  return gltf;
}

TEST(GltfMorph, WeightsOfTheMeshElseOfTheNode) {
  GltfBuilder gltf = morphed();
  expectNear(inWorld(load(gltf), 0, 1), {1, 0, 0});
  gltf.json["meshes"][0]["weights"] = {0.5, 0.25};
  const Scene byMesh = load(gltf);
  expectNear(inWorld(byMesh, 0, 1), {1, 0, 1});
  expectNear(inWorld(byMesh, 0, 2), {0, 2, 0});
  expectNear(normalOf(byMesh, 0, 1), glm::normalize(glm::dvec3(1, 0, 1)));
  gltf.json["nodes"][0]["weights"] = {1, 0};
  const Scene byNode = load(gltf);
  expectNear(inWorld(byNode, 0, 1), {1, 0, 2});
  expectNear(inWorld(byNode, 0, 2), {0, 1, 0});
}

TEST(GltfMorph, InstancesOfOneShapeShareTheirMesh) {
  GltfBuilder gltf = morphed();
  for (const double weight : {0.0, 1.0, 1.0, 0.5})
    gltf.json["nodes"].push_back({{"mesh", 0}, {"weights", {weight, 0}}});
  gltf.json["nodes"].push_back({{"mesh", 0}, {"weights", {1, 0}}, {"scale", {-1, 1, 1}}});
  const Scene scene = load(gltf);
  ASSERT_EQ(scene.instances.size(), 6u);
  EXPECT_EQ(scene.instances[0].mesh, scene.instances[1].mesh);
  EXPECT_EQ(scene.instances[2].mesh, scene.instances[3].mesh);
  EXPECT_EQ(scene.meshes.size(), 4u);  // at rest, 1, 0.5, and 1 mirrored
  expectNear(inWorld(scene, 5, 1), {-1, 0, 2});
}

TEST(GltfMorph, FlatNormalsAreThoseOfTheShapeDrawn) {
  GltfBuilder gltf = morphed();
  gltf.json["meshes"][0]["primitives"][0]["attributes"].erase("NORMAL");
  gltf.json["meshes"][0]["weights"] = {0.5, 0};
  expectNear(normalOf(load(gltf), 0, 0), glm::normalize(glm::dvec3(-1, 0, 1)));
}

TEST(GltfMorph, WeightsAreAnimated) {
  GltfBuilder gltf = morphed();
  gltf.json["meshes"][0]["weights"] = {1, 1};
  animate(gltf, 0, "weights", {0, 1}, "SCALAR", {0, 0, 1, 0.5f});
  const Scene scene = load(gltf, 0.5);
  expectNear(inWorld(scene, 0, 1), {1, 0, 1});
  expectNear(inWorld(scene, 0, 2), {0, 2, 0});
}

// --- Skins ---

TEST(GltfSkin, BendsAtItsJoints) {
  // A ribbon from x = 0 to x = 2 whose second half follows a joint at x = 1.
  const GltfBuilder gltf = test::bendingRibbon();
  const Scene rest = load(gltf);
  ASSERT_EQ(rest.instances.size(), 1u);
  for (size_t i = 0; i < 6; ++i) expectNear(inWorld(rest, 0, i), {static_cast<double>(i / 2), i % 2, 0});
  // At 1 s the joint has turned by a quarter about Y: +X goes to -Z. Its own middle follows half and half.
  const Scene bent = load(gltf, 1);
  expectNear(inWorld(bent, 0, 0), {0, 0, 0});
  expectNear(inWorld(bent, 0, 2), {1, 0, 0});
  expectNear(inWorld(bent, 0, 4), {1, 0, -1});
  expectNear(normalOf(bent, 0, 0), {0, 0, 1});
  expectNear(normalOf(bent, 0, 2), glm::normalize(glm::dvec3(1, 0, 1)));
  expectNear(normalOf(bent, 0, 4), {1, 0, 0});
}

TEST(GltfSkin, IgnoresTheTransformOfItsNode) {
  GltfBuilder gltf = test::bendingRibbon();
  gltf.json["nodes"][0].update({{"translation", {5, 6, 7}}, {"scale", {-3, 3, 3}}});
  const Scene scene = load(gltf);
  EXPECT_EQ(scene.instances[0].worldFromObject, glm::dmat4(1.0));
  expectNear(inWorld(scene, 0, 4), {2, 0, 0});
}

TEST(GltfSkin, FollowsAMovedSkeleton) {
  GltfBuilder gltf = test::bendingRibbon();
  gltf.json["nodes"][1]["translation"] = {0, 0, 10};
  expectNear(inWorld(load(gltf), 0, 4), {2, 0, 10});
}

TEST(GltfSkin, WeightsNeedNotSumToOneAndMayStandInASecondSet) {
  GltfBuilder gltf = test::bendingRibbon();
  Json& attributes = gltf.json["meshes"][0]["primitives"][0]["attributes"];
  const std::vector<uint16_t> joints(24, 0);
  std::vector<float> weights(24, 0.f);
  for (size_t vertex = 0; vertex < 6; ++vertex) weights[4 * vertex + 3] = 3;  // joint 0, thrice
  const int firstJoints = attributes["JOINTS_0"], firstWeights = attributes["WEIGHTS_0"];
  attributes["JOINTS_0"] = gltf.accessor<uint16_t>("VEC4", joints);
  attributes["WEIGHTS_0"] = gltf.accessor<float>("VEC4", weights);
  expectNear(inWorld(load(gltf, 1), 0, 4), {2, 0, 0});
  attributes["JOINTS_1"] = firstJoints;  // the ribbon's own weights, which sum to 1, beside the three
  attributes["WEIGHTS_1"] = firstWeights;
  expectNear(inWorld(load(gltf, 1), 0, 4), glm::dvec3(2, 0, 0) * 0.75 + glm::dvec3(1, 0, -1) * 0.25);
}

TEST(GltfSkin, WithoutInverseBindMatricesVerticesAreInJointSpace) {
  GltfBuilder gltf = test::bendingRibbon();
  gltf.json["skins"][0].erase("inverseBindMatrices");
  expectNear(inWorld(load(gltf), 0, 4), {3, 0, 0});
}

TEST(GltfSkin, InstancesWithSkinsOfTheirOwn) {
  GltfBuilder gltf = test::bendingRibbon();
  gltf.json["nodes"].push_back({{"mesh", 0}, {"skin", 0}});
  gltf.json["nodes"].push_back({{"mesh", 0}, {"skin", 1}});
  gltf.json["nodes"].push_back({{"mesh", 0}});
  gltf.json["nodes"].push_back({{"translation", {0, 0, 3}}});
  gltf.json["nodes"].push_back({{"translation", {0, 0, 4}}});
  gltf.json["skins"].push_back({{"joints", {6, 7}}});
  const Scene scene = load(gltf);
  ASSERT_EQ(scene.instances.size(), 4u);
  EXPECT_EQ(scene.meshes.size(), 3u);
  EXPECT_EQ(scene.instances[0].mesh, scene.instances[1].mesh);
  expectNear(inWorld(scene, 2, 4), {2, 0, 4});
  expectNear(inWorld(scene, 3, 4), {2, 0, 0});
}

TEST(GltfSkin, MorphsBeforeItBends) {
  GltfBuilder gltf = test::bendingRibbon();
  std::vector<float> offsets(18, 0.f);
  offsets[3 * 4] = 1;  // vertex 4 one further along +X
  gltf.json["meshes"][0]["primitives"][0]["targets"] =
      Json::array({{{"POSITION", gltf.accessor<float>("VEC3", offsets)}}});
  gltf.json["meshes"][0]["weights"] = {0.5};
  expectNear(inWorld(load(gltf, 1), 0, 4), {1, 0, -1.5});
}

}  // namespace
}  // namespace sfumato::scene
