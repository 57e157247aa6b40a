// What meshes and materials look like on the GPU: against the CPU reference, and known answers of its own.
#include "pipelines/geometry_gpu.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/random.h"
#include "image/metrics.h"
#include "pipelines/linked_lists_gpu.h"
#include "pipelines/reference.h"
#include "scene/gltf.h"
#include "shaders/shared/bindings.h"
#include "tests/gl/test_device.h"
#include "tests/pipelines/frame_errors.h"
#include "tests/pipelines/known_scenes.h"
#include "tests/scene/gltf_moving.h"

namespace sfumato::pipelines {
namespace {

using scene::Material;
using scene::Scene;
using scene::Texture;
using scene::TextureUse;
using scene::Wrap;

constexpr int width = 96;
constexpr int height = 72;

class GeometryOnGpu : public tests::GpuTest {
 protected:
  image::Image draw(const Scene& scene) {
    LinkedListsPipeline pipeline(device(), scene, {});
    return pipeline.render(scene.cameras[0], width, height, {.samples = 1, .shadowResolution = 1024})
        .radiance;
  }

  // Few pixels are off by more than 2 % of the mean plus 2 % of themselves: those at the edges of texels that
  // are not filtered. Texture units filter with 8 bits.
  void expectAsReference(const Scene& scene) {
    const image::Image image = draw(scene);
    const image::Image reference =
        renderReference(scene, scene.cameras[0], {}, {.width = width, .height = height});
    const PixelErrors found = errors(image, reference);
    fmt::print("failing {:.4f}, mean ratio {:.5f}, mean {:.3f}\n", found.failingFraction, found.meanRatio,
               found.mean);
    EXPECT_LT(found.failingFraction, 0.005);
    EXPECT_NEAR(found.meanRatio, 1.0, 0.002);
    EXPECT_GT(found.mean, 0.01) << "there is something to compare";
  }
};

// Every channel of every texel is its own.
Texture noise(int side, uint64_t seed) {
  base::Random random(seed);
  Texture texture{.name = "noise", .width = side, .height = side, .rgba = {}};
  for (int i = 0; i < side * side * 4; ++i)
    texture.rgba.push_back(static_cast<uint8_t>(random.uniform(64, 256)));
  return texture;
}

// Scaled, turned and moved.
glm::mat3x2 transform(double scale, double angle, const glm::vec2& offset) {
  const auto c = static_cast<float>(scale * std::cos(angle)), s = static_cast<float>(scale * std::sin(angle));
  return {c, -s, s, c, offset.x, offset.y};
}

// Sun from above the right shoulder of a camera that sees 3.2 m x 2.4 m of the plane z = 0.
Scene emptyStage() {
  Scene scene;
  scene.lights.push_back(tests::directionalLight({-1, -1, -2}, {3, 3, 3}));
  scene.cameras.push_back(tests::orthographicCamera({0, 0, 4}, {0, 0, 0}, 1.2));
  return scene;
}

// The quad of column 0 to 3 and row 0 or 1, whose two uv sets differ.
scene::Mesh tile(int column, int row) {
  scene::Mesh mesh = tests::quad({-1.56f + 0.8f * column, -1.1f + 1.2f * row, 0}, {0.7f, 0, 0}, {0, 1, 0});
  for (scene::Vertex& v : mesh.vertices) v.uv1 = {v.uv0.y * 1.5f, 1 - v.uv0.x};
  return mesh;
}

TEST_F(GeometryOnGpu, EveryTextureUseHasItsOwnTransform) {
  Scene scene = emptyStage();
  // A wall, for what is let through.
  tests::add(scene, tests::quad({-4, -4, -1}, {8, 0, 0}, {0, 8, 0}), tests::glowing({0.5f, 1, 2}));
  TextureUse Material::*const uses[] = {&Material::baseColourTexture,    &Material::metallicRoughnessTexture,
                                        &Material::normalTexture,        &Material::emissiveTexture,
                                        &Material::transmissionTexture,  &Material::specularTexture,
                                        &Material::specularColourTexture};
  constexpr Wrap wraps[] = {Wrap::Repeat, Wrap::ClampToEdge, Wrap::MirroredRepeat};
  for (int i = 0; i < MATERIAL_TEXTURES; ++i) {
    Material material = tests::lambert({0.6f, 0.7f, 0.8f});
    material.specular = 1;
    material.roughness = 0.6f;
    if (uses[i] == &Material::emissiveTexture) material.emissive = {1, 2, 3};
    if (uses[i] == &Material::transmissionTexture) material.transmission = 1;
    if (uses[i] == &Material::metallicRoughnessTexture) material.metallic = 1;
    if (uses[i] == &Material::specularColourTexture) material.specularColour = {8, 8, 8};
    material.*uses[i] = {.texture = i,
                         .uvSet = i % 2,
                         .textureFromUv = transform(1.2 + 0.1 * i, 0.4 + 0.5 * i, {0.3f * i, -0.2f * i})};
    Texture texture = noise(4, static_cast<uint64_t>(i));
    texture.wrapS = wraps[i % 3];
    texture.wrapT = wraps[(i + 1) % 3];
    texture.nearest = i == 3;
    scene.textures.push_back(texture);
    tests::add(scene, tile(i % 4, i / 4), material);
  }
  Material cut = tests::cutOut({1, 1, 1}, 1, 0.6f);
  cut.baseColourTexture = {.texture = 0, .textureFromUv = transform(1.5, 1, {0.25f, 0.5f})};
  tests::add(scene, tile(3, 1), cut);
  expectAsReference(scene);
}

TEST_F(GeometryOnGpu, UnlitShowsItsColourAndCastsShadows) {
  Scene scene = emptyStage();
  scene.lights[0] = tests::directionalLight({0, 0, -1}, {3, 3, 3});
  tests::add(scene, tests::quad({-4, -4, -1}, {8, 0, 0}, {0, 8, 0}), tests::lambert({1, 1, 1}));
  const auto addUnlit = [&](int column, Material material) {
    material.unlit = true;
    material.specular = 1;
    material.emissive = {7, 7, 7};  // does not count
    tests::add(scene, tile(column, 0), material);
  };
  addUnlit(0, tests::lambert({0.25f, 0.5f, 0.75f}));
  addUnlit(1, tests::veil({0.25f, 0.5f, 0.75f}, 0.5f));
  addUnlit(2, tests::cutOut({0.25f, 0.5f, 0.75f}, 0.25f, 0.5f));
  const image::Image image = draw(scene);
  const double wall = 3 / std::numbers::pi;
  const auto expectPixel = [&](int x, const glm::dvec3& radiance) {
    for (int channel = 0; channel < 3; ++channel)
      EXPECT_NEAR(image.pixel(x, 54)[channel], radiance[channel], 2e-3) << "at " << x;
  };
  expectPixel(11, {0.25, 0.5, 0.75});
  expectPixel(35, glm::dvec3(0.125, 0.25, 0.375) + 0.25 * wall);  // half of the light twice
  expectPixel(59, glm::dvec3(wall));                              // cut
  expectPixel(83, glm::dvec3(wall));
  // The sun moved: the opaque tile's shadow falls beside it.
  scene.lights[0] = tests::directionalLight({0, 1, -1}, {3, 3, 3});
  expectAsReference(scene);
}

// A texture of 2 x 2-texel checks: level 1 is checks of one texel, all levels above are grey.
Texture checks(scene::Minify minify) {
  Texture texture{.name = "checks", .width = 64, .height = 64, .rgba = {}};
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const uint8_t value = (x / 2 + y / 2) % 2 == 0 ? 255 : 0;
      texture.rgba.insert(texture.rgba.end(), {value, value, value, 255});
    }
  texture.minify = minify;
  return texture;
}

TEST_F(GeometryOnGpu, MinifiesAsTheSamplerSays) {
  using scene::Minify;
  // Red as transmission 1 through a pane sees it (linear data) of a texture that is `level` levels too fine.
  const auto drawn = [&](Minify minify, double level) {
    Scene scene;
    scene.cameras.push_back(tests::orthographicCamera({0, 0, 4}, {0, 0, 0}, 1.2));
    tests::add(scene, tests::quad({-4, -4, -1}, {8, 0, 0}, {0, 8, 0}), tests::glowing({1, 1, 1}));
    scene.textures.push_back(checks(minify));
    Material pane = tests::pane({1, 1, 1});
    const double texelsPerMetre = 72 / 2.4 * std::exp2(level);
    pane.transmissionTexture = {.texture = 0,
                                .textureFromUv = transform(3.2 * texelsPerMetre / 64, 0, {0.003f, 0.004f})};
    tests::add(scene, tests::quad({-1.6f, -1.6f, 0}, {3.2f, 0, 0}, {0, 3.2f, 0}), pane);
    const image::Image image = draw(scene);
    std::vector<float> red;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) red.push_back(image.pixel(x, y)[0]);
    return red;
  };
  const auto near = [](float value, float expected) { return std::abs(value - expected) < 0.02f; };
  const auto all = [](const std::vector<float>& values, auto holds) {
    return std::ranges::all_of(values, holds);
  };
  const auto isCheck = [&](float v) { return near(v, 0) || near(v, 1); };
  const auto isGrey = [&](float v) { return near(v, 0.5f); };
  EXPECT_TRUE(all(drawn(Minify::Nearest, 1.8), isCheck));
  const std::vector<float> linear = drawn(Minify::Linear, 1.8);
  EXPECT_FALSE(all(linear, isCheck));
  EXPECT_TRUE(std::ranges::any_of(linear, isCheck));
  EXPECT_TRUE(all(drawn(Minify::NearestMipmapNearest, 1.2), isCheck));
  EXPECT_TRUE(all(drawn(Minify::NearestMipmapNearest, 1.8), isGrey));
  EXPECT_FALSE(all(drawn(Minify::LinearMipmapNearest, 1.2), isCheck));
  EXPECT_TRUE(all(drawn(Minify::LinearMipmapNearest, 1.8), isGrey));
  EXPECT_TRUE(all(drawn(Minify::NearestMipmapLinear, 1.5),
                  [&](float v) { return near(v, 0.25f) || near(v, 0.75f); }));
  const std::vector<float> trilinear = drawn(Minify::LinearMipmapLinear, 1.5);
  EXPECT_TRUE(all(trilinear, [](float v) { return v > 0.23f && v < 0.77f; }));
  EXPECT_FALSE(all(trilinear, [&](float v) { return near(v, 0.25f) || near(v, 0.75f); }));
  EXPECT_TRUE(all(drawn(Minify::LinearMipmapLinear, 2.5), isGrey));
}

// --- Files, from their bytes to the frame ---

class FileOnGpu : public GeometryOnGpu {
 protected:
  static constexpr double sun = 3;  // W/m^2, straight onto the plane z = 0

  // What the file holds, under the stage's camera and a sun from behind it.
  static Scene load(const test::GltfBuilder& gltf, std::optional<double> seconds = {}) {
    const test::TemporaryFolder folder("geometry_gpu");
    Scene scene = scene::readGltf(folder.write("scene.glb", gltf.binary()), seconds);
    scene.lights.push_back(tests::directionalLight({0, 0, -1}, glm::dvec3(sun)));
    scene.cameras.push_back(tests::orthographicCamera({0, 0, 4}, {0, 0, 0}, 1.2));
    return scene;
  }

  // A square of side 2 m about the origin, four vertices.
  static test::Json square(test::GltfBuilder& gltf) {
    return {{"POSITION", gltf.accessor<float>("VEC3", {-1, -1, 0, 1, -1, 0, -1, 1, 0, 1, 1, 0})},
            {"NORMAL", gltf.accessor<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1})}};
  }

  // Draws it under a matt white material but for what is given.
  static void addSquare(test::GltfBuilder& gltf, const test::Json& attributes, test::Json material) {
    material["pbrMetallicRoughness"].update({{"metallicFactor", 0}});
    gltf.add("materials", std::move(material));
    gltf.meshNode({{"attributes", attributes}, {"mode", 5}, {"material", 0}});
  }

  static void expectPixel(const image::Image& image, glm::ivec2 at, const glm::dvec3& radiance) {
    for (int channel = 0; channel < 3; ++channel)
      EXPECT_NEAR(image.pixel(at.x, at.y)[channel], radiance[channel], 0.003 * (1 + radiance[channel]))
          << "channel " << channel << " at " << at.x << " " << at.y;
  }
};

const test::Json matt = {{"KHR_materials_specular", {{"specularFactor", 0}}}};

TEST_F(FileOnGpu, VertexColoursTintTheBaseColour) {
  test::GltfBuilder gltf;
  test::Json attributes = square(gltf);
  attributes["COLOR_0"] = gltf.accessor<uint8_t>(
      "VEC4", {255, 0, 51, 255, 0, 255, 51, 255, 255, 0, 51, 255, 0, 255, 51, 255}, true);
  addSquare(gltf, attributes,
            {{"pbrMetallicRoughness", {{"baseColorFactor", {1, 0.5, 1, 1}}}}, {"extensions", matt}});
  const Scene scene = load(gltf);
  // Pixels are 1/30 m; red falls and green rises from x = -1 to 1.
  const image::Image image = draw(scene);
  const auto expected = [](double x) {
    const double green = (x + 1) / 2;
    return glm::dvec3(1 - green, 0.5 * green, 0.2) * (sun / std::numbers::pi);
  };
  expectPixel(image, {24, 30}, expected((24.5 - 48) / 30));
  expectPixel(image, {70, 50}, expected((70.5 - 48) / 30));
  expectAsReference(scene);
}

TEST_F(FileOnGpu, QuantisedMeshesStandWhereTheirFloatsWould) {
  test::GltfBuilder gltf;
  gltf.json["extensionsUsed"] = gltf.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  // Normals lean by 45 degrees to +X: the sun, from +Z, is at cos 45.
  addSquare(
      gltf,
      {{"POSITION", gltf.accessor<int16_t>("VEC3", {-100, -100, 0, 100, -100, 0, -100, 100, 0, 100, 100, 0})},
       {"NORMAL", gltf.accessor<int8_t>("VEC3", {90, 0, 90, 90, 0, 90, 90, 0, 90, 90, 0, 90}, true)},
       {"COLOR_0", gltf.accessor<uint16_t>("VEC3", std::vector<uint16_t>(12, 32768), true)}},
      {{"extensions", matt}});
  gltf.json["nodes"][0]["scale"] = {0.01, 0.01, 0.01};
  const Scene scene = load(gltf);
  const image::Image image = draw(scene);
  const double radiance = 32768 / 65535.0 * sun * std::sqrt(0.5) / std::numbers::pi;
  expectPixel(image, {20, 20}, glm::dvec3(radiance));
  expectPixel(image, {75, 50}, glm::dvec3(radiance));
  expectPixel(image, {15, 36}, glm::dvec3(0));
  expectAsReference(scene);
}

TEST_F(FileOnGpu, EmissiveStrengthScalesTheEmission) {
  test::GltfBuilder gltf;
  addSquare(gltf, square(gltf),
            {{"pbrMetallicRoughness", {{"baseColorFactor", {0, 0, 0, 1}}}},
             {"emissiveFactor", {1, 0.5, 0.25}},
             {"extensions",
              {{"KHR_materials_specular", {{"specularFactor", 0}}},
               {"KHR_materials_emissive_strength", {{"emissiveStrength", 20}}}}}});
  const Scene scene = load(gltf);
  expectPixel(draw(scene), {48, 36}, {20, 10, 5});
  expectAsReference(scene);
}

TEST_F(FileOnGpu, IndexOfRefractionSetsTheReflection) {
  for (const double ior : {1.0, 1.5, 2.0}) {
    test::GltfBuilder gltf;
    addSquare(gltf, square(gltf),
              {{"pbrMetallicRoughness", {{"baseColorFactor", {0, 0, 0, 1}}}},
               {"extensions", {{"KHR_materials_ior", {{"ior", ior}}}}}});
    const Scene scene = load(gltf);
    // Head on at roughness 1: D = 1 / pi, V = 1 / 4, F = F0.
    const double f0 = std::pow((ior - 1) / (ior + 1), 2);
    expectPixel(draw(scene), {48, 36}, glm::dvec3(sun * f0 / (4 * std::numbers::pi)));
  }
}

TEST_F(FileOnGpu, SkinsShowTheirPose) {
  const Scene scene = load(test::bendingRibbon(), 0.5);
  // The half beyond the joint at x = 1 has turned by 45 degrees away from the viewer: it ends at x = 1.707,
  // outside the picture; the first half has not moved.
  ASSERT_EQ(scene.instances.size(), 1u);
  expectAsReference(scene);
  const Scene quarter = load(test::bendingRibbon(), 1);
  const image::Image image = draw(quarter);
  EXPECT_GT(image.pixel(60, 20)[0], 0.05);
  expectPixel(image, {82, 20}, glm::dvec3(0));  // x = 1.15: what was there has turned away
  EXPECT_GT(draw(load(test::bendingRibbon())).pixel(82, 20)[0], 0.05);
  expectAsReference(quarter);
}

}  // namespace
}  // namespace sfumato::pipelines
