#include "scene/gltf.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "base/error.h"
#include "base/file.h"
#include "tests/image/openimageio.h"
#include "tests/image/png_builder.h"
#include "tests/scene/gltf_builder.h"

namespace sfumato::scene {
namespace {

namespace fs = std::filesystem;
using test::GltfBuilder;
using test::Json;
using test::TemporaryFolder;

Scene load(const std::string& content, const std::string& name = "scene.gltf") {
  const TemporaryFolder folder("gltf");
  return readGltf(folder.write(name, content));
}

Scene load(const GltfBuilder& gltf) {
  return load(gltf.text());
}

void expectNear(const glm::dvec3& actual, const glm::dvec3& expected, double tolerance = 1e-6) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(actual[c], expected[c], tolerance) << "component " << c;
}

glm::dvec3 inWorld(const Instance& instance, const glm::dvec3& pObject) {
  return glm::dvec3(instance.worldFromObject * glm::dvec4(pObject, 1));
}

glm::dvec3 facing(const Scene& scene, const Instance& instance, size_t triangle = 0) {
  const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
  glm::dvec3 p[3];
  for (size_t k = 0; k < 3; ++k)
    p[k] = inWorld(instance, mesh.vertices[mesh.indices[3 * triangle + k]].position);
  return glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]));
}

// What `body` logs to stderr.
template <typename Body>
std::string logged(Body body) {
  testing::internal::CaptureStderr();
  body();
  return testing::internal::GetCapturedStderr();
}

size_t occurrences(const std::string& text, const std::string& part) {
  size_t count = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

// --- Where bytes come from ---

void expectTriangle(const Scene& scene) {
  ASSERT_EQ(scene.instances.size(), 1u);
  ASSERT_EQ(scene.meshes.size(), 1u);
  const Mesh& mesh = scene.meshes[0];
  ASSERT_EQ(mesh.indices, (std::vector<uint32_t>{0, 1, 2}));
  ASSERT_EQ(mesh.vertices.size(), 3u);
  expectNear(mesh.vertices[0].position, {0, 0, 0});
  expectNear(mesh.vertices[1].position, {1, 0, 0});
  expectNear(mesh.vertices[2].position, {0, 1, 0});
  ASSERT_EQ(scene.materials.size(), 1u);
  EXPECT_EQ(mesh.material, 0);
}

TEST(Gltf, BufferInADataUri) {
  expectTriangle(load(test::triangle()));
}

TEST(Gltf, BinaryContainerWhateverItsEnding) {
  expectTriangle(load(test::triangle().binary(), "scene.glb"));
  expectTriangle(load(test::triangle().binary(), "scene.gltf"));
  expectTriangle(load(test::triangle().text(), "scene.glb"));
}

TEST(Gltf, BuffersBesideTheFile) {
  const std::pair<const char*, const char*> names[] = {
      {"plain.bin", "plain.bin"},
      {"two words.bin", "two%20words.bin"},
      {"two words.bin", "two words.bin"},
      {"R\xc3\xa4ume.bin", "R%C3%A4ume.bin"},
      {"R\xc3\xa4ume.bin", "R\xc3\xa4ume.bin"},
      {"a+b.bin", "a+b.bin"},
      {"a+b.bin", "a%2Bb.bin"},
      {"../below.bin", "../below.bin"},
  };
  for (const auto& [name, uri] : names) {
    const TemporaryFolder folder("gltf buffers");
    fs::create_directories(folder.path() / "sub");
    GltfBuilder gltf = test::triangle();
    gltf.json["buffers"] = Json::array({{{"byteLength", gltf.buffer.size()}, {"uri", uri}}});
    folder.write(std::string("sub/") + name, std::string(gltf.buffer.begin(), gltf.buffer.end()));
    SCOPED_TRACE(uri);
    expectTriangle(readGltf(folder.write("sub/sc\xc3\xa8ne 1.gltf", gltf.text())));
    // A .glb may do so too.
    expectTriangle(readGltf(folder.write("sub/scene.glb", gltf.binary())));
  }
}

// --- Scenes and nodes ---

GltfBuilder threeNodes() {
  GltfBuilder gltf = test::triangle();
  gltf.json["nodes"][0]["translation"] = {1, 0, 0};
  gltf.json["nodes"].push_back({{"mesh", 0}, {"translation", {2, 0, 0}}});
  gltf.json["nodes"].push_back({{"mesh", 0}, {"translation", {3, 0, 0}}});
  return gltf;
}

std::vector<double> xOfInstances(const Scene& scene) {
  std::vector<double> x;
  for (const Instance& instance : scene.instances) x.push_back(instance.worldFromObject[3].x);
  return x;
}

TEST(Gltf, DefaultSceneElseTheFirstElseAllRoots) {
  GltfBuilder gltf = threeNodes();
  EXPECT_EQ(xOfInstances(load(gltf)), (std::vector<double>{1, 2, 3}));
  gltf.json["scenes"] = {{{"nodes", {2, 0}}}, {{"nodes", {1}}}};
  EXPECT_EQ(xOfInstances(load(gltf)), (std::vector<double>{3, 1}));
  gltf.json["scene"] = 1;
  EXPECT_EQ(xOfInstances(load(gltf)), (std::vector<double>{2}));
}

TEST(Gltf, InstancesShareTheirMesh) {
  const Scene scene = load(threeNodes());
  EXPECT_EQ(scene.meshes.size(), 1u);
  for (const Instance& instance : scene.instances) EXPECT_EQ(instance.mesh, 0);
}

TEST(Gltf, HierarchyOfTranslationRotationScale) {
  GltfBuilder gltf = test::triangle();
  gltf.json["nodes"][0].update({{"scale", {2, 3, 4}}, {"translation", {10, 0, 0}}});
  const double half = std::numbers::pi / 4;  // a quarter turn around Y
  gltf.add(
      "nodes",
      {{"rotation", {0, std::sin(half), 0, std::cos(half)}}, {"translation", {0, 0, 5}}, {"children", {0}}});
  const Scene scene = load(gltf);
  // (1,0,0) -> scaled (2,0,0) -> (12,0,0) -> turned (0,0,-12) -> (0,0,-7)
  expectNear(inWorld(scene.instances[0], {1, 0, 0}), {0, 0, -7});
  expectNear(inWorld(scene.instances[0], {0, 1, 0}), {0, 3, -5});
}

TEST(Gltf, QuaternionsAreNormalised) {
  GltfBuilder gltf = test::triangle();
  gltf.json["nodes"][0]["rotation"] = {0, 0, 7, 7};
  expectNear(inWorld(load(gltf).instances[0], {1, 0, 0}), {0, 1, 0});
}

TEST(Gltf, MatricesAreColumnMajor) {
  GltfBuilder gltf = test::triangle();
  gltf.json["nodes"][0]["matrix"] = {0, 2, 0, 0, -3, 0, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1};
  const Scene scene = load(gltf);
  expectNear(inWorld(scene.instances[0], {1, 0, 0}), {5, 8, 7});
  expectNear(inWorld(scene.instances[0], {0, 1, 0}), {2, 6, 7});
}

TEST(Gltf, DeepHierarchy) {
  constexpr int depth = 100'000;
  GltfBuilder gltf = test::triangle();
  Json nodes = Json::array();
  for (int i = 0; i < depth; ++i) nodes.push_back({{"translation", {1, 0, 0}}, {"children", {i + 1}}});
  nodes.push_back({{"mesh", 0}});
  gltf.json["nodes"] = nodes;
  const auto start = std::chrono::steady_clock::now();
  const Scene scene = load(gltf);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60));
  expectNear(inWorld(scene.instances[0], {0, 0, 0}), {depth, 0, 0});
}

// --- Accessors ---

template <typename T>
void expectPositions(const std::vector<T>& stored, bool normalized, const std::vector<glm::dvec3>& expected) {
  GltfBuilder gltf;
  gltf.meshNode({{"attributes", {{"POSITION", gltf.accessor<T>("VEC3", stored, normalized)}}}});
  const Scene scene = load(gltf);
  for (size_t i = 0; i < 3; ++i) expectNear(scene.meshes[0].vertices[i].position, expected[i], 1e-6);
}

TEST(GltfAccessor, EveryComponentType) {
  expectPositions<int8_t>({-1, 2, 3, 4, 5, -128, 7, 8, 9}, false, {{-1, 2, 3}, {4, 5, -128}, {7, 8, 9}});
  expectPositions<uint8_t>({255, 2, 3, 4, 5, 6, 7, 8, 9}, false, {{255, 2, 3}, {4, 5, 6}, {7, 8, 9}});
  expectPositions<int16_t>({-300, 2, 3, 4, 5, 6, 7, 8, 9}, false, {{-300, 2, 3}, {4, 5, 6}, {7, 8, 9}});
  expectPositions<uint16_t>({65535, 2, 3, 4, 5, 6, 7, 8, 9}, false, {{65535, 2, 3}, {4, 5, 6}, {7, 8, 9}});
  expectPositions<uint32_t>({70000, 2, 3, 4, 5, 6, 7, 8, 9}, false, {{70000, 2, 3}, {4, 5, 6}, {7, 8, 9}});
  expectPositions<float>({-1.5f, 2, 3, 4, 5, 6, 7, 8, 9}, false, {{-1.5, 2, 3}, {4, 5, 6}, {7, 8, 9}});
}

TEST(GltfAccessor, NormalisedIntegers) {
  expectPositions<int8_t>({127, -127, -128, 0, 64, 1, 2, 3, 4}, true,
                          {{1, -1, -1}, {0, 64. / 127, 1. / 127}, {2. / 127, 3. / 127, 4. / 127}});
  expectPositions<uint8_t>({255, 0, 51, 0, 0, 0, 0, 0, 1}, true, {{1, 0, 0.2}, {0, 0, 0}, {0, 0, 1. / 255}});
  expectPositions<int16_t>({32767, -32767, -32768, 0, 0, 0, 0, 0, 1}, true,
                           {{1, -1, -1}, {0, 0, 0}, {0, 0, 1. / 32767}});
  expectPositions<uint16_t>({65535, 0, 13107, 0, 0, 0, 0, 0, 1}, true,
                            {{1, 0, 0.2}, {0, 0, 0}, {0, 0, 1. / 65535}});
}

TEST(GltfAccessor, InterleavedViewWithOffsets) {
  GltfBuilder gltf;
  // position, then uv, of 20 bytes a vertex, after 8 bytes of something else
  const std::vector<float> data = {9, 9, 0, 0, 0, 0.1f, 0.2f, 1, 0, 0, 0.3f, 0.4f, 0, 1, 0, 0.5f, 0.6f};
  const int view = gltf.view(data);
  gltf.json["bufferViews"][0].update({{"byteStride", 20}, {"byteOffset", 8}, {"byteLength", 60}});
  gltf.add("accessors", {{"bufferView", view}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}});
  gltf.add(
      "accessors",
      {{"bufferView", view}, {"byteOffset", 12}, {"componentType", 5126}, {"count", 3}, {"type", "VEC2"}});
  gltf.meshNode({{"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 1}}}});
  const Mesh mesh = load(gltf).meshes[0];
  expectNear(mesh.vertices[1].position, {1, 0, 0});
  expectNear(mesh.vertices[2].position, {0, 1, 0});
  EXPECT_FLOAT_EQ(mesh.vertices[0].uv0.y, 0.2f);
  EXPECT_FLOAT_EQ(mesh.vertices[2].uv0.x, 0.5f);
}

TEST(GltfAccessor, SparseOverBaseAndOverZeros) {
  GltfBuilder gltf = test::triangle();
  const int indices = gltf.view<uint16_t>({2, 0});
  const int values = gltf.view<float>({0, 7, 0, 8, 8, 8});
  Json sparse = {{"count", 2},
                 {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                 {"values", {{"bufferView", values}}}};
  gltf.json["accessors"][0]["sparse"] = sparse;
  const Mesh overBase = load(gltf).meshes[0];
  expectNear(overBase.vertices[0].position, {8, 8, 8});
  expectNear(overBase.vertices[1].position, {1, 0, 0});
  expectNear(overBase.vertices[2].position, {0, 7, 0});
  gltf.json["accessors"][0].erase("bufferView");
  const Mesh overZeros = load(gltf).meshes[0];
  expectNear(overZeros.vertices[0].position, {8, 8, 8});
  expectNear(overZeros.vertices[1].position, {0, 0, 0});
  expectNear(overZeros.vertices[2].position, {0, 7, 0});
}

template <typename T>
void expectIndices() {
  GltfBuilder gltf;
  const int positions = gltf.accessor<float>("VEC3", std::vector<float>(15));
  const int normals = gltf.accessor<float>("VEC3", std::vector<float>(15));
  const int indices = gltf.accessor<T>("SCALAR", {4, 0, 3});
  gltf.meshNode({{"attributes", {{"POSITION", positions}, {"NORMAL", normals}}}, {"indices", indices}});
  EXPECT_EQ(load(gltf).meshes[0].indices, (std::vector<uint32_t>{4, 0, 3}));
}

TEST(GltfAccessor, EveryIndexType) {
  expectIndices<uint8_t>();
  expectIndices<uint16_t>();
  expectIndices<uint32_t>();
}

// --- Primitives ---

TEST(GltfPrimitive, StripsAndFans) {
  GltfBuilder gltf;
  const int positions = gltf.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0});
  const int normals = gltf.accessor<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1});
  const Json attributes = {{"POSITION", positions}, {"NORMAL", normals}};
  gltf.meshNode({{"attributes", attributes}, {"mode", 5}});
  gltf.meshNode({{"attributes", attributes}, {"mode", 6}});
  const Scene scene = load(gltf);
  EXPECT_EQ(scene.meshes[0].indices, (std::vector<uint32_t>{0, 1, 2, 1, 3, 2}));
  EXPECT_EQ(scene.meshes[1].indices, (std::vector<uint32_t>{1, 2, 0, 2, 3, 0}));
  EXPECT_EQ(scene.meshes[0].vertices.size(), 4u);
}

TEST(GltfPrimitive, PointsAndLinesAreLeftOutWithOneWarning) {
  GltfBuilder gltf = test::triangle();
  for (int mode : {0, 1, 2, 3}) {
    Json primitive = gltf.json["meshes"][0]["primitives"][0];
    primitive["mode"] = mode;
    gltf.json["meshes"][0]["primitives"].push_back(primitive);
  }
  Scene scene;
  const std::string log = logged([&] { scene = load(gltf); });
  EXPECT_EQ(scene.meshes.size(), 1u);
  EXPECT_EQ(scene.instances.size(), 1u);
  EXPECT_EQ(occurrences(log, "points and lines"), 1u) << log;
}

TEST(GltfPrimitive, WhatHasNoTrianglesIsLeftOut) {
  GltfBuilder gltf = threeNodes();
  const int two = gltf.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0});
  gltf.json["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", two}}}, {"mode", 5}});
  const Scene scene = load(gltf);
  EXPECT_EQ(scene.meshes.size(), 1u);
  EXPECT_EQ(scene.instances.size(), 3u);
}

TEST(GltfPrimitive, MissingNormalsAreFlat) {
  GltfBuilder gltf;
  // Two triangles that share an edge, at a right angle.
  const int positions = gltf.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
  const int indices = gltf.accessor<uint8_t>("SCALAR", {0, 1, 2, 0, 2, 3});
  const int tangents = gltf.accessor<float>("VEC4", {0, 1, 0, -1, 0, 1, 0, -1, 0, 1, 0, -1, 0, 1, 0, -1});
  gltf.meshNode({{"attributes", {{"POSITION", positions}, {"TANGENT", tangents}}}, {"indices", indices}});
  const Mesh mesh = load(gltf).meshes[0];
  ASSERT_EQ(mesh.vertices.size(), 6u);
  for (size_t i = 0; i < 3; ++i) {
    expectNear(mesh.vertices[i].normal, {0, 0, 1});
    expectNear(mesh.vertices[i + 3].normal, {1, 0, 0});
    EXPECT_EQ(mesh.vertices[i].tangent.w, 1.f);  // tangents without normals do not count
  }
}

TEST(GltfPrimitive, AttributesArrive) {
  GltfBuilder gltf;
  Json attributes;
  attributes["POSITION"] = gltf.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
  attributes["NORMAL"] = gltf.accessor<float>("VEC3", {0, 0, 2, 0, 0.6f, 0.8f, 0, 0, 1});
  attributes["TANGENT"] = gltf.accessor<float>("VEC4", {3, 0, 0, -1, 1, 0, 0, 1, 0, 1, 0, 1});
  attributes["TEXCOORD_0"] = gltf.accessor<uint8_t>("VEC2", {255, 0, 0, 51, 0, 0}, true);
  attributes["TEXCOORD_1"] = gltf.accessor<float>("VEC2", {-2, 3, 0, 0, 0, 0});
  attributes["COLOR_0"] = gltf.accessor<uint16_t>("VEC4", {65535, 0, 0, 13107, 0, 0, 0, 0, 0, 0, 0, 0}, true);
  gltf.meshNode({{"attributes", attributes}});
  const Mesh mesh = load(gltf).meshes[0];
  expectNear(mesh.vertices[0].normal, {0, 0, 1});
  expectNear(mesh.vertices[1].normal, {0, 0.6, 0.8});
  EXPECT_EQ(mesh.vertices[0].tangent, glm::vec4(1, 0, 0, -1));
  EXPECT_EQ(mesh.vertices[0].uv0, glm::vec2(1, 0));
  EXPECT_FLOAT_EQ(mesh.vertices[1].uv0.y, 0.2f);
  EXPECT_EQ(mesh.vertices[0].uv1, glm::vec2(-2, 3));
  EXPECT_EQ(mesh.vertices[0].colour, glm::vec4(1, 0, 0, 0.2f));
}

TEST(GltfPrimitive, ColourWithoutAlphaIsOpaque) {
  GltfBuilder gltf = test::triangle();
  gltf.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] =
      gltf.accessor<float>("VEC3", {0.5f, 0.25f, 2, 1, 1, 1, 1, 1, 1});
  EXPECT_EQ(load(gltf).meshes[0].vertices[0].colour, glm::vec4(0.5f, 0.25f, 2, 1));
}

TEST(GltfPrimitive, WithoutMaterialTakesTheDefaultOne) {
  GltfBuilder gltf = test::triangle();
  gltf.add("materials", {{"name", "red"}, {"pbrMetallicRoughness", {{"metallicFactor", 0}}}});
  Json second = gltf.json["meshes"][0]["primitives"][0];
  second["material"] = 0;
  gltf.json["meshes"][0]["primitives"].push_back(second);
  gltf.json["meshes"][0]["primitives"].push_back(gltf.json["meshes"][0]["primitives"][0]);
  const Scene scene = load(gltf);
  ASSERT_EQ(scene.materials.size(), 2u);
  EXPECT_EQ(scene.meshes[0].material, 1);
  EXPECT_EQ(scene.meshes[1].material, 0);
  EXPECT_EQ(scene.meshes[2].material, 1);
  const Material& standard = scene.materials[1];
  EXPECT_EQ(standard.baseColour, glm::vec4(1));
  EXPECT_EQ(standard.metallic, 1.f);
  EXPECT_EQ(standard.roughness, 1.f);
  EXPECT_EQ(standard.alphaMode, AlphaMode::Opaque);
  EXPECT_FALSE(standard.doubleSided);
}

// --- Mirrors and flattening ---

TEST(GltfInstance, MirroredOnesKeepTheirFrontFaces) {
  GltfBuilder gltf = threeNodes();
  gltf.json["nodes"][1]["scale"] = {-1, 1, 1};
  gltf.json["nodes"][2]["scale"] = {-2, -2, -2};
  const int normals = gltf.accessor<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
  gltf.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = normals;
  const Scene scene = load(gltf);
  ASSERT_EQ(scene.meshes.size(), 2u);  // both mirrored instances share the mirrored mesh
  EXPECT_EQ(scene.instances[0].mesh, 0);
  EXPECT_EQ(scene.instances[1].mesh, 1);
  EXPECT_EQ(scene.instances[2].mesh, 1);
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
    const glm::dmat3 normalMatrix = glm::transpose(glm::inverse(glm::dmat3(instance.worldFromObject)));
    const glm::dvec3 normal = glm::normalize(normalMatrix * glm::dvec3(mesh.vertices[0].normal));
    expectNear(facing(scene, instance), normal);
    // The bitangent of the object, taken to the world, is what the world makes of normal and tangent.
    const glm::vec4 tangent = mesh.vertices[0].tangent;
    const glm::dvec3 worldTangent = glm::dmat3(instance.worldFromObject) * glm::dvec3(tangent);
    const glm::dvec3 bitangent = glm::normalize(glm::cross(normal, worldTangent)) * double(tangent.w);
    expectNear(bitangent, glm::normalize(glm::dmat3(instance.worldFromObject) * glm::dvec3(0, 1, 0)));
  }
}

TEST(GltfInstance, TwoMirrorsAreNone) {
  GltfBuilder gltf = test::triangle();
  gltf.json["nodes"][0]["scale"] = {-1, 1, 1};
  gltf.add("nodes", {{"children", {0}}, {"scale", {1, -1, 1}}});
  const Scene scene = load(gltf);
  EXPECT_EQ(scene.meshes.size(), 1u);
  expectNear(facing(scene, scene.instances[0]), {0, 0, 1});
}

TEST(GltfInstance, FlattenedOnesHaveAnInvertibleTransform) {
  GltfBuilder gltf = test::triangle();
  gltf.json["nodes"][0].update({{"scale", {2, 3, 0}}, {"translation", {0, 0, 4}}});
  const Scene scene = load(gltf);
  ASSERT_EQ(scene.instances.size(), 1u);
  EXPECT_NE(glm::determinant(scene.instances[0].worldFromObject), 0);
  const Mesh& mesh = scene.meshes[static_cast<size_t>(scene.instances[0].mesh)];
  expectNear(inWorld(scene.instances[0], mesh.vertices[2].position), {0, 3, 4});
  expectNear(mesh.vertices[2].normal, {0, 0, 1});
}

// --- Materials ---

GltfBuilder withMaterial(Json material) {
  GltfBuilder gltf = test::triangle();
  gltf.add("materials", std::move(material));
  gltf.json["meshes"][0]["primitives"][0]["material"] = 0;
  return gltf;
}

int addPng(GltfBuilder& gltf, uint8_t grey) {
  const std::vector<uint8_t> rows = {grey, 20};
  const auto png = test::PngBuilder(2, 1, 8, 0, rows).bytes();
  std::vector<uint8_t> bytes(png.size());
  std::transform(png.begin(), png.end(), bytes.begin(),
                 [](std::byte b) { return std::to_integer<uint8_t>(b); });
  return gltf.add("images", {{"bufferView", gltf.view(bytes)}, {"mimeType", "image/png"}});
}

TEST(GltfMaterial, EveryFactor) {
  const Scene scene = load(withMaterial(
      {{"name", "glass"},
       {"pbrMetallicRoughness",
        {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}}, {"metallicFactor", 0.5}, {"roughnessFactor", 0.6}}},
       {"emissiveFactor", {0.25, 0.5, 1}},
       {"alphaMode", "MASK"},
       {"alphaCutoff", 0.7},
       {"doubleSided", true},
       {"extensions",
        {{"KHR_materials_transmission", {{"transmissionFactor", 0.8}}},
         {"KHR_materials_specular", {{"specularFactor", 0.9}, {"specularColorFactor", {0.5, 1, 2}}}},
         {"KHR_materials_emissive_strength", {{"emissiveStrength", 4}}}}}}));
  const Material& m = scene.materials[0];
  EXPECT_EQ(m.name, "glass");
  EXPECT_EQ(m.baseColour, glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
  EXPECT_EQ(m.metallic, 0.5f);
  EXPECT_EQ(m.roughness, 0.6f);
  EXPECT_EQ(m.emissive, glm::vec3(1, 2, 4));
  EXPECT_EQ(m.alphaMode, AlphaMode::Mask);
  EXPECT_EQ(m.alphaCutoff, 0.7f);
  EXPECT_TRUE(m.doubleSided);
  EXPECT_EQ(m.transmission, 0.8f);
  EXPECT_EQ(m.specular, 0.9f);
  EXPECT_EQ(m.specularColour, glm::vec3(0.5f, 1, 2));
  EXPECT_TRUE(m.translucent());
}

TEST(GltfMaterial, ShadowsFromExtras) {
  const auto read = [](const Json& extras) { return load(withMaterial({{"extras", extras}})).materials[0]; };
  const Material all = read({{"shadow_self", false}, {"shadow_once", true}, {"shadow_rim", 1.5}});
  EXPECT_FALSE(all.shadowSelf);
  EXPECT_TRUE(all.shadowOnce);
  EXPECT_EQ(all.shadowRim, 1.5f);
  const Material none = read({{"something_else", "of another program"}});
  EXPECT_TRUE(none.shadowSelf);
  EXPECT_FALSE(none.shadowOnce);
  EXPECT_EQ(none.shadowRim, 0.f);
  EXPECT_EQ(read({{"shadow_rim", 2}}).shadowRim, 2.f);
}

TEST(GltfMaterial, IndexOfRefractionScalesTheSpecularColour) {
  const auto specular = [](double ior) {
    return load(withMaterial({{"extensions", {{"KHR_materials_ior", {{"ior", ior}}}}}}))
        .materials[0]
        .specularColour.g;
  };
  EXPECT_NEAR(specular(1.5), 1, 1e-6);
  EXPECT_NEAR(specular(2), (1. / 9) / 0.04, 1e-5);
  EXPECT_NEAR(specular(1), 0, 1e-9);
  EXPECT_NEAR(specular(0), 25, 1e-5);
}

TEST(GltfMaterial, TexturesWithSamplersAndUvSets) {
  if (!test::hasOpenImageIO()) GTEST_SKIP() << "this build has no OpenImageIO";
  GltfBuilder gltf = withMaterial(
      {{"pbrMetallicRoughness",
        {{"baseColorTexture", {{"index", 0}}},
         {"metallicRoughnessTexture", {{"index", 1}, {"texCoord", 1}}}}},
       {"normalTexture", {{"index", 0}, {"scale", -2}}},
       {"emissiveTexture", {{"index", 1}}},
       {"extensions",
        {{"KHR_materials_transmission", {{"transmissionTexture", {{"index", 0}, {"texCoord", 1}}}}},
         {"KHR_materials_specular",
          {{"specularTexture", {{"index", 1}}}, {"specularColorTexture", {{"index", 0}}}}}}}});
  addPng(gltf, 10);
  addPng(gltf, 99);
  gltf.add("samplers", {{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}});
  gltf.add("textures", {{"source", 1}, {"sampler", 0}, {"name", "wood"}});
  gltf.add("textures", {{"source", 0}});
  const Scene scene = load(gltf);
  ASSERT_EQ(scene.textures.size(), 2u);
  const Material& m = scene.materials[0];
  const Texture& wood = scene.textures[static_cast<size_t>(m.baseColourTexture.texture)];
  EXPECT_EQ(wood.name, "wood");
  EXPECT_EQ(wood.width, 2);
  EXPECT_EQ(wood.height, 1);
  EXPECT_EQ(wood.rgba, (std::vector<uint8_t>{99, 99, 99, 255, 20, 20, 20, 255}));
  EXPECT_EQ(wood.wrapS, Wrap::ClampToEdge);
  EXPECT_EQ(wood.wrapT, Wrap::MirroredRepeat);
  EXPECT_TRUE(wood.nearest);
  const Texture& other = scene.textures[static_cast<size_t>(m.metallicRoughnessTexture.texture)];
  EXPECT_EQ(other.rgba[0], 10);
  EXPECT_EQ(other.wrapS, Wrap::Repeat);
  EXPECT_FALSE(other.nearest);
  EXPECT_EQ(m.metallicRoughnessTexture.uvSet, 1);
  EXPECT_EQ(m.normalTexture.texture, m.baseColourTexture.texture);
  EXPECT_EQ(m.normalScale, -2.f);
  EXPECT_EQ(m.emissiveTexture.texture, m.metallicRoughnessTexture.texture);
  EXPECT_EQ(m.transmissionTexture.uvSet, 1);
  EXPECT_EQ(m.transmissionTexture.texture, m.baseColourTexture.texture);
  EXPECT_EQ(m.specularTexture.texture, m.metallicRoughnessTexture.texture);
  EXPECT_EQ(m.specularColourTexture.texture, m.baseColourTexture.texture);
}

TEST(GltfMaterial, EveryMinificationFilter) {
  if (!test::hasOpenImageIO()) GTEST_SKIP() << "this build has no OpenImageIO";
  const auto minify = [](const Json& sampler) {
    GltfBuilder gltf = withMaterial({{"emissiveTexture", {{"index", 0}}}});
    addPng(gltf, 1);
    gltf.add("samplers", sampler);
    gltf.add("textures", {{"source", 0}, {"sampler", 0}});
    return load(gltf).textures[0].minify;
  };
  EXPECT_EQ(minify({{"minFilter", 9728}}), Minify::Nearest);
  EXPECT_EQ(minify({{"minFilter", 9729}}), Minify::Linear);
  EXPECT_EQ(minify({{"minFilter", 9984}}), Minify::NearestMipmapNearest);
  EXPECT_EQ(minify({{"minFilter", 9985}}), Minify::LinearMipmapNearest);
  EXPECT_EQ(minify({{"minFilter", 9986}}), Minify::NearestMipmapLinear);
  EXPECT_EQ(minify({{"minFilter", 9987}}), Minify::LinearMipmapLinear);
  EXPECT_EQ(minify({{"magFilter", 9728}}), Minify::LinearMipmapLinear);
}

TEST(GltfMaterial, UnlitKeepsItsColourOnly) {
  const Material m = load(withMaterial({{"pbrMetallicRoughness", {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}}}},
                                        {"alphaMode", "BLEND"},
                                        {"extensions",
                                         {{"KHR_materials_unlit", Json::object()},
                                          {"KHR_materials_transmission", {{"transmissionFactor", 0.8}}}}}}))
                         .materials[0];
  EXPECT_TRUE(m.unlit);
  EXPECT_EQ(m.baseColour, glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
  EXPECT_EQ(m.alphaMode, AlphaMode::Blend);
  EXPECT_EQ(m.transmission, 0.f);
  EXPECT_FALSE(load(withMaterial({{"name", "lit"}})).materials[0].unlit);
}

// Where the use reads its texture for a vertex's (u, v).
glm::dvec2 inTexture(const TextureUse& use, double u, double v) {
  return glm::dmat3x2(use.textureFromUv) * glm::dvec3(u, v, 1);
}

TEST(GltfMaterial, TextureTransforms) {
  if (!test::hasOpenImageIO()) GTEST_SKIP() << "this build has no OpenImageIO";
  const auto transform = [](Json value) {
    return Json{{"index", 0}, {"extensions", {{"KHR_texture_transform", std::move(value)}}}};
  };
  const double quarter = std::numbers::pi / 2;
  GltfBuilder gltf = withMaterial(
      {{"pbrMetallicRoughness",
        {{"baseColorTexture", transform({{"offset", {0.25, 0.5}}})},
         {"metallicRoughnessTexture", transform({{"rotation", quarter}})}}},
       {"normalTexture", transform({{"scale", {2, 3}}})},
       {"emissiveTexture",
        transform({{"offset", {0.5, 0.25}}, {"rotation", quarter}, {"scale", {2, 4}}, {"texCoord", 1}})},
       {"extensions",
        {{"KHR_materials_transmission", {{"transmissionTexture", transform({{"offset", {7, 8}}})}}},
         {"KHR_materials_specular", {{"specularTexture", {{"index", 0}}}}}}}});
  addPng(gltf, 10);
  gltf.add("textures", {{"source", 0}});
  gltf.json["extensionsRequired"] = gltf.json["extensionsUsed"] = {"KHR_texture_transform"};
  const Material m = load(gltf).materials[0];
  const auto expectAt = [](const TextureUse& use, double u, double v, double uTexture, double vTexture) {
    EXPECT_NEAR(inTexture(use, u, v).x, uTexture, 1e-6);
    EXPECT_NEAR(inTexture(use, u, v).y, vTexture, 1e-6);
  };
  expectAt(m.baseColourTexture, 0.1, 0.2, 0.35, 0.7);
  // Counter-clockwise on the picture, whose v falls: right goes to the top.
  expectAt(m.metallicRoughnessTexture, 1, 0, 0, -1);
  expectAt(m.metallicRoughnessTexture, 0, 1, 1, 0);
  expectAt(m.normalTexture, 0.1, 0.2, 0.2, 0.6);
  expectAt(m.emissiveTexture, 1, 0, 0.5, -1.75);  // (2, 0), (0, -2), (0.5, -1.75)
  expectAt(m.emissiveTexture, 0, 1, 4.5, 0.25);   // (0, 4), (4, 0), (4.5, 0.25)
  EXPECT_EQ(m.emissiveTexture.uvSet, 1);
  expectAt(m.transmissionTexture, 0, 0, 7, 8);
  expectAt(m.specularTexture, 0.1, 0.2, 0.1, 0.2);
}

TEST(GltfMaterial, PicturesFromDataUriAndFile) {
  if (!test::hasOpenImageIO()) GTEST_SKIP() << "this build has no OpenImageIO";
  const std::vector<uint8_t> rows = {77};
  const auto png = test::PngBuilder(1, 1, 8, 0, rows).bytes();
  const std::string bytes(reinterpret_cast<const char*>(png.data()), png.size());
  const TemporaryFolder folder("gltf pictures");
  folder.write("wood 1.png", bytes);
  GltfBuilder gltf = withMaterial({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}},
                                   {"emissiveTexture", {{"index", 1}}}});
  const std::span<const uint8_t> view(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size());
  gltf.add("images", {{"uri", "wood%201.png"}});
  gltf.add("images", {{"uri", "data:image/png;base64," + test::base64(view)}});
  gltf.add("textures", {{"source", 0}});
  gltf.add("textures", {{"source", 1}});
  const Scene scene = readGltf(folder.write("scene.gltf", gltf.text()));
  ASSERT_EQ(scene.textures.size(), 2u);
  for (const Texture& texture : scene.textures)
    EXPECT_EQ(texture.rgba, (std::vector<uint8_t>{77, 77, 77, 255}));
}

TEST(GltfMaterial, NormalTextureMakesTangents) {
  if (!test::hasOpenImageIO()) GTEST_SKIP() << "this build has no OpenImageIO";
  GltfBuilder gltf;
  Json attributes;
  attributes["POSITION"] = gltf.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
  attributes["NORMAL"] = gltf.accessor<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1});
  attributes["TEXCOORD_1"] = gltf.accessor<float>("VEC2", {0, 0, 0, -1, -1, 0});  // u along -Y, v along -X
  gltf.meshNode({{"attributes", attributes}, {"material", 0}});
  addPng(gltf, 1);
  gltf.add("textures", {{"source", 0}});
  gltf.add("materials", {{"normalTexture", {{"index", 0}, {"texCoord", 1}}}});
  const Scene scene = load(gltf);
  for (const Vertex& v : scene.meshes[0].vertices) {
    expectNear(v.tangent, {0, -1, 0});
    // The bitangent points to where v falls: along +X.
    expectNear(glm::cross(v.normal, glm::vec3(v.tangent)) * v.tangent.w, {1, 0, 0});
  }
}

// --- Cameras and lights ---

TEST(GltfCamera, Perspective) {
  GltfBuilder gltf;
  gltf.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}});
  gltf.add("cameras", {{"type", "perspective"},
                       {"name", "long"},
                       {"perspective", {{"yfov", 1}, {"znear", 2}, {"zfar", 30}}}});
  gltf.add("nodes", {{"camera", 0}, {"name", "eye"}, {"translation", {1, 2, 3}}});
  gltf.add("nodes", {{"camera", 1}});
  const Scene scene = load(gltf);
  ASSERT_EQ(scene.cameras.size(), 2u);
  const Camera& eye = scene.cameras[0];
  EXPECT_EQ(eye.name, "eye");
  EXPECT_FALSE(eye.orthographic);
  EXPECT_EQ(eye.yfov, 0.5);
  EXPECT_EQ(eye.nearDistance, 0.1);
  EXPECT_EQ(eye.farDistance, infinity);
  expectNear(glm::dvec3(eye.worldFromView[3]), {1, 2, 3});
  EXPECT_EQ(scene.cameras[1].name, "long");
  EXPECT_EQ(scene.cameras[1].farDistance, 30);
}

TEST(GltfCamera, Orthographic) {
  GltfBuilder gltf;
  gltf.add("cameras", {{"type", "orthographic"},
                       {"orthographic", {{"xmag", 4}, {"ymag", 3}, {"znear", 0}, {"zfar", 9}}}});
  gltf.add("nodes", {{"camera", 0}});
  const Camera camera = load(gltf).cameras.at(0);
  EXPECT_TRUE(camera.orthographic);
  EXPECT_EQ(camera.yMagnitude, 3);
  EXPECT_EQ(camera.nearDistance, 0);
  EXPECT_EQ(camera.farDistance, 9);
}

TEST(GltfCamera, TransformIsRotationAndTranslationOnly) {
  GltfBuilder gltf;
  gltf.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}});
  const double half = std::numbers::pi / 4;
  gltf.add("nodes", {{"camera", 0},
                     {"rotation", {0, std::sin(half), 0, std::cos(half)}},
                     {"translation", {0, 0, 1}},
                     {"scale", {2, 3, 4}}});
  gltf.add("nodes", {{"children", {0}}, {"scale", {5, 6, 7}}});  // shears what is turned below it
  const glm::dmat4 m = load(gltf).cameras.at(0).worldFromView;
  expectNear(-glm::dvec3(m[2]), {-1, 0, 0});  // turned left by 90 degrees, it looks along -X
  expectNear(glm::dvec3(m[1]), {0, 1, 0});
  expectNear(glm::dvec3(m[0]), {0, 0, -1});
  expectNear(glm::dvec3(m[3]), {0, 0, 7});
  EXPECT_NEAR(glm::determinant(m), 1, 1e-12);
}

TEST(GltfLight, EveryType) {
  GltfBuilder gltf;
  gltf.light({{"type", "directional"}, {"color", {1, 0.5, 0.25}}, {"intensity", 4}, {"name", "sun"}});
  gltf.json["nodes"][0]["rotation"] = {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)};  // -Z turned to -Y
  gltf.json["nodes"][0]["scale"] = {3, 5, 7};
  gltf.light({{"type", "point"}, {"range", 12.5}});
  gltf.json["nodes"][1].update({{"translation", {1, 2, 3}}, {"name", "lamp"}});
  gltf.light({{"type", "spot"}, {"spot", Json::object()}});
  gltf.light(
      {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 1.5707963705062866}}}});
  const Scene scene = load(gltf);
  ASSERT_EQ(scene.lights.size(), 4u);
  const Light& sun = scene.lights[0];
  EXPECT_EQ(sun.name, "sun");
  EXPECT_EQ(sun.type, LightType::Directional);
  expectNear(sun.intensity, {4, 2, 1});
  expectNear(sun.direction, {0, -1, 0});
  EXPECT_EQ(sun.range, infinity);
  const Light& lamp = scene.lights[1];
  EXPECT_EQ(lamp.name, "lamp");
  EXPECT_EQ(lamp.type, LightType::Point);
  expectNear(lamp.position, {1, 2, 3});
  expectNear(lamp.intensity, {1, 1, 1});
  EXPECT_EQ(lamp.range, 12.5);
  EXPECT_EQ(scene.lights[2].type, LightType::Spot);
  EXPECT_EQ(scene.lights[2].innerCone, 0);
  EXPECT_NEAR(scene.lights[2].outerCone, std::numbers::pi / 4, 1e-9);
  expectNear(scene.lights[2].direction, {0, 0, -1});
  EXPECT_EQ(scene.lights[3].innerCone, 0.25);
  EXPECT_EQ(scene.lights[3].outerCone, std::numbers::pi / 2);  // single precision's pi/2 is a hair more
}

TEST(GltfLight, MayCastNoShadow) {
  GltfBuilder gltf;
  gltf.light({{"type", "point"}});
  gltf.light({{"type", "point"}, {"extras", {{"shadow", false}}}});
  gltf.light({{"type", "spot"}, {"spot", Json::object()}})["extras"]["shadow"] = false;
  gltf.light({{"type", "point"}, {"extras", {{"shadow", false}}}})["extras"]["shadow"] =
      true;  // the node's counts
  std::vector<bool> cast;
  for (const Light& light : load(gltf).lights) cast.push_back(light.castsShadow);
  EXPECT_EQ(cast, (std::vector<bool>{true, false, false, true}));
}

TEST(GltfScene, AmbientLightIsThatOfTheDefaultScene) {
  GltfBuilder gltf = test::triangle();
  EXPECT_EQ(load(gltf).ambient, glm::dvec3(0));
  gltf.json["scenes"] = {{{"nodes", {0}}, {"extras", {{"ambient", {9, 9, 9}}}}},
                         {{"nodes", {0}}, {"extras", {{"ambient", {0.5, 1, 2}}}}}};
  gltf.json["scene"] = 1;
  EXPECT_EQ(load(gltf).ambient, glm::dvec3(0.5, 1, 2));
}

// --- Volumes ---

TEST(GltfVolume, AllExtras) {
  const TemporaryFolder folder("gltf volume");
  GltfBuilder gltf;
  gltf.add("nodes", {{"translation", {1, 2, 3}},
                     {"extras",
                      {{"volume", "smoke/a 1.vdb"},
                       {"volume_grid", "density"},
                       {"volume_scale", 7},
                       {"volume_extinction", {1, 0, 2.5}},
                       {"volume_albedo", {0, 0.5, 1}},
                       {"volume_g", -0.5}}}});
  gltf.add("nodes", {{"extras", {{"volume", "b.vdb"}}}});
  gltf.add("nodes", {{"extras", {{"unrelated", {1, "two", nullptr}}}}});
  const Scene scene = readGltf(folder.write("scene.gltf", gltf.text()));
  ASSERT_EQ(scene.volumes.size(), 2u);
  const VolumePlacement& smoke = scene.volumes[0];
  EXPECT_EQ(smoke.file, (folder.path() / "smoke/a 1.vdb").string());
  EXPECT_EQ(smoke.gridName, "density");
  EXPECT_EQ(smoke.scale, 7);
  EXPECT_EQ(smoke.extinctionColour, glm::dvec3(1, 0, 2.5));
  EXPECT_EQ(smoke.albedo, glm::dvec3(0, 0.5, 1));
  EXPECT_EQ(smoke.g, -0.5);
  expectNear(glm::dvec3(smoke.worldFromGridWorld[3]), {1, 2, 3});
  EXPECT_EQ(scene.volumes[1].gridName, "");
  EXPECT_EQ(scene.volumes[1].scale, 1);
  EXPECT_EQ(scene.volumes[1].extinctionColour, glm::dvec3(1));
  EXPECT_EQ(scene.volumes[1].albedo, glm::dvec3(0.9));
  EXPECT_EQ(scene.volumes[1].g, 0);
}

TEST(GltfVolume, Fire) {
  GltfBuilder gltf;
  const auto burning = [&](test::Json extras) {
    extras["volume"] = "a.vdb";
    gltf.add("nodes", {{"extras", extras}});
  };
  burning({{"volume_fire", "temperature"}});
  burning({{"volume_fire", "heat"},
           {"volume_fire_kelvin", 2500},
           {"volume_fire_strength", 0.25},
           {"volume_fire_lights", 8}});
  burning({{"volume_fire", "temperature"}, {"volume_fire_ramp", {{0, 0, 0}, {1, 0.5, 0.25}}}});
  burning({{"volume_fire", "flame"}});
  burning({});
  const Scene scene = load(gltf);
  ASSERT_EQ(scene.volumes.size(), 5u);
  const auto fire = [&](size_t i) { return scene.volumes[i].fire; };
  EXPECT_EQ(fire(0).gridName, "temperature");
  EXPECT_EQ(fire(0).look.kelvin, 1.0);
  EXPECT_EQ(fire(0).look.strength, 1);
  EXPECT_EQ(fire(0).lights, 0);
  EXPECT_EQ(fire(1).look.kelvin, 2500.0);
  EXPECT_EQ(fire(1).look.strength, 0.25);
  EXPECT_EQ(fire(1).lights, 8);
  EXPECT_FALSE(fire(2).look.kelvin);
  EXPECT_EQ(fire(2).look.ramp, (std::vector<glm::dvec3>{{0, 0, 0}, {1, 0.5, 0.25}}));
  EXPECT_FALSE(fire(3).look.kelvin);
  EXPECT_GE(fire(3).look.ramp.size(), 2u);
  EXPECT_EQ(fire(4).gridName, "");
}

// --- Extensions ---

TEST(GltfExtensions, UnknownOptionalOnesWarnOnceEach) {
  GltfBuilder gltf = test::triangle();
  gltf.json["extensionsUsed"] = {"EXT_strange", "EXT_other", "EXT_strange", "KHR_lights_punctual"};
  const std::string log = logged([&] { expectTriangle(load(gltf)); });
  EXPECT_EQ(occurrences(log, "EXT_strange"), 1u) << log;
  EXPECT_EQ(occurrences(log, "EXT_other"), 1u) << log;
  EXPECT_EQ(occurrences(log, "KHR_lights_punctual"), 0u) << log;
}

TEST(GltfExtensions, SupportedOnesMayBeRequired) {
  GltfBuilder gltf = test::triangle();
  gltf.json["extensionsUsed"] =
      gltf.json["extensionsRequired"] = {"KHR_lights_punctual", "KHR_mesh_quantization"};
  const std::string log = logged([&] { expectTriangle(load(gltf)); });
  EXPECT_EQ(log, "");
}

// --- A file that we did not make ---

TEST(Gltf, GlassTable) {
  const char* data = std::getenv("SFUMATO_DATA");
  if (!data) GTEST_SKIP() << "SFUMATO_DATA names no folder with glass-table.glb";
  const fs::path file = fs::path(data) / "glass-table.glb";
  if (!fs::exists(file)) GTEST_SKIP() << file << " is not there";
  const Scene scene = readGltf(file);
  EXPECT_EQ(scene.instances.size(), 5u);
  EXPECT_EQ(scene.meshes.size(), 5u);
  ASSERT_EQ(scene.materials.size(), 3u);
  size_t triangles = 0;
  for (const Mesh& mesh : scene.meshes) triangles += mesh.indices.size() / 3;
  EXPECT_EQ(triangles, 592u);
  EXPECT_EQ(scene.materials[0].alphaMode, AlphaMode::Blend);
  EXPECT_FLOAT_EQ(scene.materials[0].transmission, 0.761163197927877f);
  EXPECT_TRUE(scene.materials[0].translucent());
  EXPECT_FALSE(scene.materials[1].translucent());
  // Faces and normals agree in the world.
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
    const glm::dmat3 normalMatrix = glm::transpose(glm::inverse(glm::dmat3(instance.worldFromObject)));
    for (size_t t = 0; t < mesh.indices.size() / 3; ++t) {
      const glm::dvec3 normal(mesh.vertices[mesh.indices[3 * t]].normal);
      EXPECT_GT(glm::dot(facing(scene, instance, t), normalMatrix * normal), 0);
    }
  }
}

}  // namespace
}  // namespace sfumato::scene
