#include "pipelines/reference_shading.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/random.h"
#include "tests/pipelines/known_scenes.h"

namespace sfumato::pipelines {
namespace {

constexpr double pi = std::numbers::pi;

void expectNear(const glm::dvec3& value, const glm::dvec3& expected, double tolerance) {
  for (int channel = 0; channel < 3; ++channel)
    EXPECT_NEAR(value[channel], expected[channel], tolerance) << "channel " << channel;
}

glm::dvec3 direction(double polar, double azimuth) {
  return {std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar)};
}

Reflector reflector(const scene::Material& material) {
  const scene::Scene scene;
  const SurfacePoint point;
  return reflectorAt(scene, material, point, coverageAt(scene, material, point));
}

scene::Material dielectric(const glm::vec3& colour, float roughness) {
  scene::Material material = tests::lambert(colour);
  material.specular = 1;
  material.roughness = roughness;
  return material;
}

scene::Material metal(const glm::vec3& colour, float roughness) {
  scene::Material material = dielectric(colour, roughness);
  material.metallic = 1;
  return material;
}

TEST(ReferenceShading, LambertIsAlbedoOverPi) {
  const Reflector plain = reflector(tests::lambert({0.75f, 0.5f, 0.25f}));
  expectNear(brdf(plain, direction(0.3, 0), direction(1.2, 2)), glm::dvec3(0.75, 0.5, 0.25) / pi, 1e-15);
  EXPECT_EQ(brdf(plain, direction(0.3, 0), direction(1.6, 2)), glm::dvec3(0)) << "from behind";
}

// Head on all cosines are 1: D = 1 / (pi alpha^2), V = 1/4, F = F0.
TEST(ReferenceShading, HeadOnValues) {
  const glm::dvec3 n(0, 0, 1);
  const double d = 1 / (pi * std::pow(0.5, 4));
  expectNear(brdf(reflector(metal({1, 0.5f, 0.25f}, 0.5f)), n, n), d / 4 * glm::dvec3(1, 0.5, 0.25), 1e-12);
  expectNear(brdf(reflector(dielectric({0.5f, 0.5f, 0.5f}, 0.5f)), n, n),
             glm::dvec3(0.5 / pi * 0.96 + d / 4 * 0.04), 1e-12);
  // The roughness is held at 0.03 and above.
  EXPECT_EQ(brdf(reflector(metal({1, 1, 1}, 0.f)), n, n), brdf(reflector(metal({1, 1, 1}, 0.03f)), n, n));
}

TEST(ReferenceShading, SpecularFactorsOfTheExtension) {
  scene::Material material = dielectric({0, 0, 0}, 1);
  material.specular = 0.5f;
  material.specularColour = {1, 0.5f, 50};  // 50 * 0.04 is held at 1
  const Reflector r = reflector(material);
  expectNear(r.specular0, {0.02, 0.01, 0.5}, 1e-9);
  EXPECT_DOUBLE_EQ(r.specular90, 0.5);
}

TEST(ReferenceShading, LightAndViewerMayBeExchanged) {
  const Reflector r = reflector(dielectric({0.6f, 0.4f, 0.2f}, 0.3f));
  base::Random random(5);
  for (int i = 0; i < 100; ++i) {
    const glm::dvec3 v = direction(random.uniform(0, 1.5), random.uniform(0, 6));
    const glm::dvec3 l = direction(random.uniform(0, 1.5), random.uniform(0, 6));
    expectNear(brdf(r, v, l), brdf(r, l, v), 1e-9);
  }
}

// The part of uniform light that comes back, by the midpoint rule in polar angle and azimuth.
double directionalAlbedo(const Reflector& r, double viewPolar) {
  const int polarSteps = 2000;
  const int azimuthSteps = 400;
  const glm::dvec3 toViewer = direction(viewPolar, 0);
  double sum = 0;
  for (int i = 0; i < polarSteps; ++i) {
    const double polar = (i + 0.5) / polarSteps * pi / 2;
    for (int k = 0; k < azimuthSteps; ++k)
      sum += brdf(r, toViewer, direction(polar, (k + 0.5) / azimuthSteps * pi)).x * std::sin(polar) *
             std::cos(polar);
  }
  return 2 * sum * (pi / 2 / polarSteps) * (pi / azimuthSteps);
}

// GGX alone sends back at most what arrives; a rough metal loses what bounces among its facets more than
// once. The tolerance is the quadrature's.
TEST(ReferenceShading, TheSpecularLobeSendsBackLessThanArrives) {
  for (const float roughness : {0.2f, 0.5f, 1.f})
    for (const double polar : {0.0, 0.6, 1.2, 1.5}) {
      const double fromMetal = directionalAlbedo(reflector(metal({1, 1, 1}, roughness)), polar);
      EXPECT_LE(fromMetal, 1 + 1e-3) << roughness << " " << polar;
      EXPECT_GT(fromMetal, 0.3) << roughness << " " << polar;
      EXPECT_LE(directionalAlbedo(reflector(dielectric({0, 0, 0}, roughness)), polar), fromMetal);
    }
  // A smooth white metal seen head on is a mirror: its facets hardly hide one another.
  EXPECT_NEAR(directionalAlbedo(reflector(metal({1, 1, 1}, 0.2f)), 0), 1, 2e-3);
}

// glTF mixes diffuse and specular by the Fresnel term of the half vector. That keeps a white dielectric below
// 1 up to about 45 degrees; nearer to grazing the diffuse term gives up less than the lobe adds.
TEST(ReferenceShading, AWhiteDielectricSendsBackAtMostWhatArrivesFromTheFront) {
  for (const float roughness : {0.2f, 0.5f, 1.f})
    for (const double polar : {0.0, 0.3, 0.6})
      EXPECT_LE(directionalAlbedo(reflector(dielectric({1, 1, 1}, roughness)), polar), 1 + 1e-3)
          << roughness << " " << polar;
}

// D is a distribution of facets: what they show of themselves head on, integral of D cos, is 1. Read off a
// metal with V = 1 / (4 cosL cosV) undone by hand, viewer and light both along the facet's normal.
TEST(ReferenceShading, FacetsCoverTheSurface) {
  const double roughness = 0.5;
  const double width2 = std::pow(roughness, 4);
  const Reflector r = reflector(metal({1, 1, 1}, roughness));
  const int steps = 20000;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double polar = (i + 0.5) / steps * pi / 2;
    const double cosine = std::cos(polar);
    const glm::dvec3 h = direction(polar, 1);
    const double visibility = 0.25 / (cosine * std::sqrt(cosine * cosine * (1 - width2) + width2));
    sum += brdf(r, h, h).x / visibility * cosine * 2 * pi * std::sin(polar) * (pi / 2 / steps);
  }
  EXPECT_NEAR(sum, 1, 1e-6);
}

// A surface that is half there does half of what it does.
TEST(ReferenceShading, AlphaScalesAllThatIsReflected) {
  scene::Material material = dielectric({0.8f, 0.6f, 0.4f}, 0.5f);
  material.specularColour = {10, 5, 2};
  const Reflector whole = reflector(material);
  material.alphaMode = scene::AlphaMode::Blend;
  material.baseColour.a = 0.5f;
  const Reflector half = reflector(material);
  const glm::dvec3 toViewer = direction(1.3, 0);
  for (const double polar : {0.2, 0.8, 1.3})
    expectNear(2.0 * brdf(half, toViewer, direction(polar, pi)), brdf(whole, toViewer, direction(polar, pi)),
               1e-12);
  expectNear(2.0 * ambientAlbedo(half), ambientAlbedo(whole), 1e-12);
}

TEST(ReferenceShading, WhatPasses) {
  const scene::Scene scene;
  const auto passing = [&](const scene::Material& m) { return coverageAt(scene, m, {}).passing(); };
  EXPECT_EQ(passing(tests::lambert({0.5f, 0.5f, 0.5f})), glm::dvec3(0));
  expectNear(passing(tests::pane({0.75f, 0.5f, 0.25f})), {0.75, 0.5, 0.25}, 1e-15);
  expectNear(passing(tests::veil({0.75f, 0.5f, 0.25f}, 0.25f)), {0.75, 0.75, 0.75}, 1e-15);
  scene::Material both = tests::veil({0.75f, 0.5f, 0.25f}, 0.5f);
  both.transmission = 0.5f;
  expectNear(passing(both), {0.6875, 0.625, 0.5625}, 1e-15);
  EXPECT_EQ(passing(tests::cutOut({1, 1, 1}, 0.25f, 0.5f)), glm::dvec3(1)) << "cut";
  EXPECT_EQ(passing(tests::cutOut({1, 1, 1}, 0.5f, 0.5f)), glm::dvec3(0)) << "kept at the cut-off";
  scene::Material opaque = tests::veil({1, 1, 1}, 0.25f);
  opaque.alphaMode = scene::AlphaMode::Opaque;
  EXPECT_EQ(passing(opaque), glm::dvec3(0)) << "OPAQUE ignores alpha";
}

TEST(ReferenceShading, AlphaAndTransmissionTakeFromTheDiffuseTerm) {
  scene::Material material = tests::veil({0.8f, 0.4f, 0.2f}, 0.5f);
  material.transmission = 0.25f;
  material.metallic = 0.5f;
  material.emissive = {4, 2, 1};
  const Reflector r = reflector(material);
  expectNear(r.diffuse, glm::dvec3(0.8, 0.4, 0.2) * 0.5 * 0.5 * 0.75, 1e-7);
  expectNear(r.emitted, {2, 1, 0.5}, 1e-15);
  EXPECT_DOUBLE_EQ(r.alpha, 0.5);
}

TEST(ReferenceShading, UnlitEmitsItsColourAndReflectsNothing) {
  scene::Material material = tests::veil({0.8f, 0.4f, 0.2f}, 0.5f);
  material.specular = 1;
  material.metallic = 0.5f;
  material.emissive = {4, 2, 1};
  material.unlit = true;
  const Reflector r = reflector(material);
  expectNear(r.emitted, glm::dvec3(0.4, 0.2, 0.1), 1e-7);
  EXPECT_EQ(brdf(r, direction(0.3, 0), direction(1.2, 2)), glm::dvec3(0));
}

TEST(ReferenceShading, PointLightFallsWithTheSquareAndItsWindow) {
  scene::Light light = tests::pointLight({0, 3, 4}, {10, 20, 30});
  const Illumination far = illuminate(light, {0, 0, 0});
  EXPECT_DOUBLE_EQ(far.distance, 5);
  expectNear(far.toLight, {0, 0.6, 0.8}, 1e-15);
  expectNear(far.irradiance, glm::dvec3(10, 20, 30) / 25.0, 1e-12);
  light.range = 10;
  expectNear(illuminate(light, {0, 0, 0}).irradiance, glm::dvec3(10, 20, 30) / 25.0 * (1 - 0.0625), 1e-12);
  light.range = 5;
  EXPECT_EQ(illuminate(light, {0, 0, 0}).irradiance, glm::dvec3(0));
  EXPECT_EQ(illuminate(light, light.position).irradiance, glm::dvec3(0)) << "no infinity at the light itself";
}

TEST(ReferenceShading, SpotFallsBetweenItsCones) {
  const double inner = 0.3;
  const double outer = 0.5;
  const scene::Light light = tests::spotLight({0, 0, 0}, {0, -1, 0}, {8, 8, 8}, inner, outer);
  const auto at = [&](double angle) {
    return illuminate(light, 2.0 * glm::dvec3(std::sin(angle), -std::cos(angle), 0)).irradiance.x / 2;
  };
  EXPECT_DOUBLE_EQ(at(0), 1);
  EXPECT_DOUBLE_EQ(at(0.299), 1);
  EXPECT_DOUBLE_EQ(at(0.501), 0);
  EXPECT_DOUBLE_EQ(at(3), 0);
  const double angle = 0.42;
  const double linear = (std::cos(angle) - std::cos(outer)) / (std::cos(inner) - std::cos(outer));
  EXPECT_NEAR(at(angle), linear * linear, 1e-12);
}

// Two texels, black and white: half way between, the linear mean of both, not the mean of the codes.
TEST(ReferenceShading, TexturesAreDecodedBeforeFiltering) {
  scene::Texture texture;
  texture.width = 2;
  texture.height = 1;
  texture.rgba = {0, 0, 0, 0, 255, 255, 255, 255};
  EXPECT_NEAR(sampleTexture(texture, {0.5, 0.5}, true).r, 0.5, 1e-12);
  EXPECT_NEAR(sampleTexture(texture, {0.25, 0.5}, true).r, 0, 1e-12);
  EXPECT_NEAR(sampleTexture(texture, {0.375, 0.5}, true).a, 0.25, 1e-12);
  texture.rgba = {188, 188, 188, 188, 188, 188, 188, 188};
  EXPECT_NEAR(sampleTexture(texture, {0.7, 0.5}, true).r, 0.502886, 1e-6);  // ((188/255 + 0.055) / 1.055)^2.4
  EXPECT_NEAR(sampleTexture(texture, {0.7, 0.5}, true).a, 188 / 255.0, 1e-12) << "alpha is linear";
  EXPECT_NEAR(sampleTexture(texture, {0.7, 0.5}, false).r, 188 / 255.0, 1e-12);
}

TEST(ReferenceShading, TexturesWrap) {
  scene::Texture texture;
  texture.width = 4;
  texture.height = 1;
  texture.rgba = {0, 0, 0, 255, 51, 0, 0, 255, 102, 0, 0, 255, 204, 0, 0, 255};
  const auto at = [&](double u) { return 255 * sampleTexture(texture, {u, 0}, false).r; };
  EXPECT_NEAR(at(0.375), 51, 1e-9);
  EXPECT_NEAR(at(0), 102, 1e-9) << "repeats: half of the first, half of the last";
  EXPECT_NEAR(at(-7.625), 51, 1e-9);
  texture.wrapS = scene::Wrap::ClampToEdge;
  EXPECT_NEAR(at(0), 0, 1e-9);
  EXPECT_NEAR(at(1e30), 204, 1e-9);
  texture.wrapS = scene::Wrap::MirroredRepeat;
  EXPECT_NEAR(at(0), 0, 1e-9);
  EXPECT_NEAR(at(1.125), 204, 1e-9);
  EXPECT_NEAR(at(-0.375), 51, 1e-9);
  EXPECT_NEAR(at(1), 204, 1e-9);
  texture.nearest = true;
  EXPECT_NEAR(at(0.49), 51, 1e-9);
  EXPECT_NEAR(at(0.51), 102, 1e-9);
}

TEST(ReferenceShading, TexturesStandWhereTheMaterialSays) {
  scene::Scene scene;
  scene::Texture texture;
  texture.width = texture.height = 1;
  texture.rgba = {255, 128, 64, 51};
  scene.textures = {texture};
  scene::Material material = dielectric({1, 1, 1}, 1);
  material.metallic = 1;
  material.transmission = 0.5f;
  material.alphaMode = scene::AlphaMode::Blend;
  material.metallicRoughnessTexture.texture = material.transmissionTexture.texture = 0;
  material.specularTexture.texture = material.baseColourTexture.texture = 0;
  const Coverage coverage = coverageAt(scene, material, {});
  EXPECT_NEAR(coverage.alpha, 0.2, 1e-12);
  EXPECT_NEAR(coverage.transmission, 0.5, 1e-12);  // R
  EXPECT_NEAR(coverage.baseColour.g, 0.215861, 1e-6);
  const Reflector r = reflectorAt(scene, material, {}, coverage);
  EXPECT_NEAR(r.roughness, 128 / 255.0, 1e-12);  // G
  const double metallic = 64 / 255.0;            // B
  EXPECT_NEAR(r.diffuse.r, (1 - metallic) * 0.2 * 0.5, 1e-12);
  EXPECT_NEAR(r.specular90, 0.2 * (1 - metallic) + metallic, 1e-12);  // A
}

TEST(ReferenceShading, NormalMapsTurnTheShadingNormal) {
  scene::Scene scene;
  scene::Texture texture;
  texture.width = texture.height = 1;
  texture.rgba = {255, 128, 128, 255};
  scene.textures = {texture};
  scene::Material material = tests::lambert({1, 1, 1});
  material.normalTexture.texture = 0;
  SurfacePoint point;
  point.tangent = {0, 2, 0.5, -1};  // bitangent -(n x t) = +x
  const double small = 2 * 128 / 255.0 - 1;
  const glm::dvec3 expected = glm::normalize(glm::dvec3(small, 1, small));
  const auto normalAt = [&] { return reflectorAt(scene, material, point, Coverage()).normal; };
  expectNear(normalAt(), expected, 1e-12);
  material.normalScale = 0.5f;
  expectNear(normalAt(), glm::normalize(glm::dvec3(small / 2, 0.5, small)), 1e-12);
  material.normalScale = 1;
  point.geometricNormal = {0, 0, -1};  // seen from behind
  expectNear(normalAt(), -expected, 1e-12);
}

}  // namespace
}  // namespace sfumato::pipelines
