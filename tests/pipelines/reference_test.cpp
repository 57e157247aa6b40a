#include "pipelines/reference.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "tests/pipelines/known_scenes.h"
#include "volumes/reference_march.h"

namespace sfumato::pipelines {
namespace {

using tests::KnownScene;

constexpr double pi = std::numbers::pi;
constexpr int width = 16;
constexpr int height = 12;
constexpr double aspect = 4.0 / 3;
constexpr double storedAsFloat = 2e-7;  // relative: the picture's own rounding

image::Image render(const KnownScene& known, const ReferenceOptions& options) {
  return renderReference(known.scene, known.scene.cameras[0], known.media, options);
}

// Steps of half a voxel that end at the kinks of a block's profile, where the march is exact; a hair longer,
// so that rounding adds no step.
image::Image render(const KnownScene& known) {
  return render(known, {.width = width, .height = height, .stepVoxels = 0.5 + 1e-9});
}

glm::dvec3 at(const image::Image& image, int x, int y) {
  const float* p = image.pixel(x, y);
  return {p[0], p[1], p[2]};
}

void expectNear(const glm::dvec3& value, const glm::dvec3& expected, double relative) {
  for (int channel = 0; channel < 3; ++channel)
    EXPECT_NEAR(value[channel], expected[channel], relative * std::abs(expected[channel]))
        << "channel " << channel;
}

void expectEverywhere(const image::Image& image, const glm::dvec3& expected, double relative) {
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      SCOPED_TRACE(testing::Message() << "pixel " << x << ", " << y);
      expectNear(at(image, x, y), expected, relative);
    }
}

// A pixel's centre: x to the right, y up, -1 to 1 across the picture.
glm::dvec2 centreOf(int px, int py) {
  return {(px + 0.5) / width * 2 - 1, 1 - (py + 0.5) / height * 2};
}

// What the camera over the plane, 3 m above the origin with x to the right and -z up, sees at a pixel.
glm::dvec3 onPlane(int px, int py) {
  const glm::dvec2 p = centreOf(px, py) * (3 * std::tan(0.6));
  return {p.x * aspect, 0, -p.y};
}

TEST(Reference, PointLightOverAPlane) {
  const image::Image image = render(tests::planeUnderPointLight());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double squared = 4 + glm::dot(onPlane(x, y), onPlane(x, y));
      const double cosine = 2 / std::sqrt(squared);
      const glm::dvec3 expected =
          glm::dvec3(0.75, 0.5, 0.25) / pi * glm::dvec3(10, 20, 30) * cosine / squared;
      expectNear(at(image, x, y), expected, storedAsFloat);
    }
}

TEST(Reference, SpotConeOverAPlane) {
  const image::Image image = render(tests::planeUnderSpotLight());
  int lit = 0;
  int between = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double squared = 4 + glm::dot(onPlane(x, y), onPlane(x, y));
      const double cosine = 2 / std::sqrt(squared);
      const double linear = (cosine - std::cos(0.5)) / (std::cos(0.3) - std::cos(0.5));
      const double profile = std::pow(std::clamp(linear, 0.0, 1.0), 2);
      lit += profile > 0;
      between += profile > 0 && profile < 1;
      const glm::dvec3 expected =
          glm::dvec3(0.75, 0.5, 0.25) / pi * glm::dvec3(10, 20, 30) * cosine / squared * profile;
      // The cone's edge magnifies rounding: its slope there is 2 / (cos inner - cos outer).
      expectNear(at(image, x, y), expected, profile < 1 ? 1e-6 : storedAsFloat);
    }
  EXPECT_GT(between, 10);
  EXPECT_LT(lit, width * height / 2);
}

TEST(Reference, CrossedPanesFilterTheShadowAndTheEye) {
  const image::Image image = render(tests::crossedPanes());
  const glm::dvec3 red(0.75, 0.25, 0.25);
  const glm::dvec3 blue(0.25, 0.5, 1);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const glm::dvec2 p = centreOf(x, y) * glm::dvec2(2 * aspect, 2);
      // A ray straight down crosses the same panes as the light straight down: each counts twice.
      glm::dvec3 passing(1);
      if (std::abs(p.x) < 2 && std::abs(p.y) < 0.6) passing *= red * red;
      if (std::abs(p.x) < 0.6) passing *= blue * blue;
      SCOPED_TRACE(testing::Message() << "pixel " << x << ", " << y);
      expectNear(at(image, x, y), passing * 3.0 / pi, storedAsFloat);
    }
}

const glm::dvec3 paneColour(0.75, 0.5, 0.25);
const glm::dvec3 wallRadiance(0.5, 1, 2);

// Light that nothing shadows, scattered by a block of optical depth 1.5 through cos = -0.8 towards the
// camera: albedo p E (1 - exp(-1.5)). Exact for the march, which integrates each step in closed form.
glm::dvec3 scatteredByBlock() {
  const double phase = (1 - 0.16) / (4 * pi * std::pow(1 + 0.16 + 2 * 0.4 * 0.8, 1.5));
  return glm::dvec3(0.9, 0.6, 0.3) * glm::dvec3(4, 5, 6) * phase * (1 - std::exp(-1.5));
}

TEST(Reference, PaneBeforeSmoke) {
  expectEverywhere(render(tests::paneBeforeSmoke()),
                   paneColour * (scatteredByBlock() + std::exp(-1.5) * wallRadiance), storedAsFloat);
}

TEST(Reference, SmokeBeforePane) {
  expectEverywhere(render(tests::smokeBeforePane()),
                   scatteredByBlock() + std::exp(-1.5) * paneColour * wallRadiance, storedAsFloat);
}

TEST(Reference, PaneInsideSmoke) {
  KnownScene known = tests::smokeBeforePane();
  known.scene.meshes[1] = tests::quad({-4, -4, 0.25f}, {8, 0, 0}, {0, 8, 0});
  known.scene.meshes[1].material = 1;
  const double phase = (1 - 0.16) / (4 * pi * std::pow(1 + 0.16 + 2 * 0.4 * 0.8, 1.5));
  const glm::dvec3 source = glm::dvec3(0.9, 0.6, 0.3) * glm::dvec3(4, 5, 6) * phase;
  const double before = std::exp(-1.5 * 0.25);
  const glm::dvec3 expected = source * (1 - before) +
                              before * paneColour * source * (1 - std::exp(-1.5 * 0.75)) +
                              std::exp(-1.5) * paneColour * wallRadiance;
  // The pane cuts the block at z = 1/4, at a voxel's face, not at a kink of the profile; steps of 1/2 voxel
  // end at the kinks on the near side (9 voxels from the box, half of it a step), so that this too is exact.
  expectEverywhere(render(known), expected, storedAsFloat);
}

TEST(Reference, SlabLetsExpOfMinusDepthThrough) {
  KnownScene known = tests::smokeBeforePane();
  known.scene.lights.clear();
  known.scene.instances.pop_back();  // the pane
  expectEverywhere(render(known), std::exp(-1.5) * wallRadiance, storedAsFloat);
  known.media[0].scale = 15;
  expectEverywhere(render(known), std::exp(-15.) * wallRadiance, storedAsFloat);
}

// Two media in one place add their extinctions and scatter each in its own way.
TEST(Reference, OverlappingMediaAdd) {
  KnownScene known = tests::smokeBeforePane();
  known.scene.instances.pop_back();
  known.media.push_back(tests::block({-4, -4, -0.5}, {4, 4, 0.5}, {4, 4, 16}, 0.5, {0.2, 0.4, 0.8}, -0.3));
  const auto phase = [](double g) { return (1 - g * g) / (4 * pi * std::pow(1 + g * g + 2 * g * 0.8, 1.5)); };
  const glm::dvec3 scattering =
      1.5 * glm::dvec3(0.9, 0.6, 0.3) * phase(0.4) + 0.5 * glm::dvec3(0.2, 0.4, 0.8) * phase(-0.3);
  const double passing = std::exp(-2.0);
  expectEverywhere(render(known),
                   scattering / 2.0 * glm::dvec3(4, 5, 6) * (1 - passing) + passing * wallRadiance,
                   storedAsFloat);
}

// A slab, light from the camera's side along its normal: both ways the same depth s is crossed, so that the
// radiance is albedo p E times the integral of exp(-2 s) from 0 to tau.
TEST(Reference, SlabLitFromTheFront) {
  KnownScene known = tests::smokeBeforePane();
  known.scene.instances.clear();
  known.scene.lights = {tests::directionalLight({0, 0, -1}, {4, 5, 6})};
  const double phase = (1 - 0.16) / (4 * pi * std::pow(1 + 0.16 + 2 * 0.4, 1.5));
  const glm::dvec3 expected =
      glm::dvec3(0.9, 0.6, 0.3) * glm::dvec3(4, 5, 6) * phase * (1 - std::exp(-3.)) / 2.0;
  // The light is taken at each step's middle: an error of about (sigma step)^2 / 24 with steps of 1/64 m; the
  // kinks of the ramps and the march towards the light, which ends within a step of one, add as much.
  expectEverywhere(render(known, {.width = 4, .height = 3, .stepVoxels = 0.25, .shadowStepVoxels = 0.05}),
                   expected, 1e-4);
}

// The same with the light slanting in from behind, cosine 0.8: exp(-s) exp(-(tau - s) / 0.8).
TEST(Reference, SlabLitFromBehind) {
  KnownScene known = tests::smokeBeforePane();
  known.scene.instances.clear();
  known.scene.lights = {tests::directionalLight({0, 3, 4}, {4, 5, 6})};
  known.media = {tests::block({-64, -64, -0.5}, {64, 64, 0.5}, {4, 4, 16}, 1.5, {0.9, 0.6, 0.3}, 0.4)};
  const double phase = (1 - 0.16) / (4 * pi * std::pow(1 + 0.16 - 2 * 0.4 * 0.8, 1.5));
  const double integral = (std::exp(-1.5) - std::exp(-1.5 / 0.8)) / (1 / 0.8 - 1);
  const glm::dvec3 expected = glm::dvec3(0.9, 0.6, 0.3) * glm::dvec3(4, 5, 6) * phase * integral;
  expectEverywhere(render(known, {.width = 4, .height = 3, .stepVoxels = 0.25, .shadowStepVoxels = 0.05}),
                   expected, 1e-4);
}

// Irradiance through the slab at cosine 0.8 along 1 / 0.8 m of extinction 0.8: exp(-1).
TEST(Reference, SunThroughSmokeOntoAFloor) {
  const glm::dvec3 expected = glm::dvec3(0.75, 0.5, 0.25) / pi * glm::dvec3(4, 5, 6) * 0.8 * std::exp(-1.0);
  // Steps end within a step of the four kinks: step^2 / 2 in voxels, each 1/16 m of 0.8 / m.
  const ReferenceOptions options = {.width = width, .height = height, .shadowStepVoxels = 0.05};
  expectEverywhere(render(tests::smokeOverFloor(), options), expected, 2e-4);
}

TEST(Reference, ALightThatCastsNoShadowPassesEverything) {
  KnownScene known = tests::smokeOverFloor();
  known.scene.lights[0].castsShadow = false;
  expectEverywhere(render(known), glm::dvec3(0.75, 0.5, 0.25) / pi * glm::dvec3(4, 5, 6) * 0.8,
                   storedAsFloat);
}

TEST(Reference, AGlassBoxShadowsByBothItsFaces) {
  const image::Image image = render(tests::glassBoxOverFloor());
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const glm::dvec2 p = centreOf(x, y) * glm::dvec2(2 * aspect, 2);
      const glm::dvec3 t(0.5, 0.75, 0.875);
      const bool below = std::abs(p.x) < 1 && std::abs(p.y) < 1;
      expectNear(at(image, x, y), (below ? t * t : glm::dvec3(1)) * 3.0 / pi, storedAsFloat);
    }
}

TEST(Reference, VeilsOverAWall) {
  const glm::dvec3 front(0.25, 0.25, 1);
  const glm::dvec3 middle(0.75, 0.25, 0.25);
  const double e = 3 / pi;
  const glm::dvec3 expected =
      0.5 * front * e + 0.5 * (0.25 * middle * e * 0.5 + 0.75 * (0.5 * e * 0.5 * 0.75));
  expectEverywhere(render(tests::veilsOverWall()), expected, storedAsFloat);
}

TEST(Reference, CutOutsLetEverythingPass) {
  KnownScene known = tests::veilsOverWall();
  known.scene.materials[1] = tests::cutOut({1, 0, 0}, 0.25f, 0.5f);
  known.scene.materials[2] = tests::cutOut({0, 1, 0}, 0.25f, 0.5f);
  expectEverywhere(render(known), glm::dvec3(0.5 * 3 / pi), storedAsFloat);
  known.scene.materials[1].alphaCutoff = 0.25f;  // kept: red, opaque
  const image::Image image = render(known);
  expectEverywhere(image, glm::dvec3(3 / pi, 0, 0), storedAsFloat);
}

// A texture whose left half is cut: the wall shows there, lit, and nothing of it elsewhere.
TEST(Reference, MaskFollowsItsTexture) {
  KnownScene known = tests::veilsOverWall();
  scene::Texture texture;
  texture.width = 2;
  texture.height = 1;
  texture.nearest = true;
  texture.rgba = {255, 255, 255, 0, 255, 255, 255, 255};
  known.scene.textures = {texture};
  known.scene.materials[2] = tests::cutOut({0, 1, 0}, 1, 0.5f);
  known.scene.materials[2].baseColourTexture.texture = 0;
  known.scene.materials[1] = tests::cutOut({1, 1, 1}, 0, 0.5f);  // all of it
  const image::Image image = render(known);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      expectNear(at(image, x, y), x < width / 2 ? glm::dvec3(0.5 * 3 / pi) : glm::dvec3(0, 3 / pi, 0),
                 storedAsFloat);
}

// A pane of many triangles between sun and floor; light and eye run exactly through their corners, edges and
// diagonals. A leak would show as 1, an edge counted twice as t^2.
TEST(Reference, TilesOfAPaneNeitherLeakNorCountTwice) {
  KnownScene known = tests::crossedPanes();
  scene::Scene& scene = known.scene;
  scene.instances.resize(1);
  tests::add(scene, tests::tiledQuad({-4, 2, 4}, {8, 0, 0}, {0, 0, -8}, 64), tests::pane({0.5f, 0.5f, 0.5f}));
  scene.cameras[0].yMagnitude = 3;  // pixels of 1/2 m: every ray through a corner of the tiles, or a diagonal
  expectEverywhere(render(known), glm::dvec3(0.25 * 3 / pi), storedAsFloat);
  scene.lights[0] = tests::directionalLight({1, -2, 0}, {3, 3, 3});  // 1 m to the side: corners again
  known.scene.instances.pop_back();
  tests::add(scene, tests::tiledQuad({-8, 2, 8}, {16, 0, 0}, {0, 0, -16}, 64),
             tests::pane({0.5f, 0.5f, 0.5f}));
  expectEverywhere(render(known), glm::dvec3(0.25 * 3 / pi * 2 / std::sqrt(5.)), storedAsFloat);
}

// Flat facets, one light from the viewer's side: every facet that faces it is lit in full, no surface shadows
// itself.
TEST(Reference, NoSurfaceShadowsItself) {
  KnownScene known;
  scene::Mesh ball = tests::sphere(8, 16);
  scene::Mesh facets;
  for (size_t i = 0; i < ball.indices.size(); i += 3) {
    const auto corner = [&](size_t k) { return ball.vertices[ball.indices[i + k]].position; };
    const glm::vec3 normal = glm::normalize(glm::cross(corner(1) - corner(0), corner(2) - corner(0)));
    for (size_t k = 0; k < 3; ++k) {
      facets.indices.push_back(static_cast<uint32_t>(facets.vertices.size()));
      facets.vertices.emplace_back();
      facets.vertices.back().position = corner(k);
      facets.vertices.back().normal = normal;
    }
  }
  scene::Material closed = tests::lambert({1, 1, 1});
  closed.doubleSided = false;
  tests::add(known.scene, facets, closed);
  known.scene.cameras = {tests::orthographicCamera({0, 0, 3}, {0, 0, 0}, 1)};
  known.scene.lights = {tests::directionalLight({0, 0, -1}, {1, 1, 1})};
  const image::Image lit = render(known, {.width = 64, .height = 48});
  known.scene.lights[0].castsShadow = false;
  const image::Image expected = render(known, {.width = 64, .height = 48});
  for (int y = 0; y < lit.height; ++y)
    for (int x = 0; x < lit.width; ++x) expectNear(at(lit, x, y), at(expected, x, y), 0);
  EXPECT_GT(at(lit, 32, 24).x, 0.9 / pi);
}

TEST(Reference, BackFacesAreSeenOnlyWhereTheMaterialIsDoubleSided) {
  KnownScene known = tests::veilsOverWall();
  known.scene.instances.resize(1);
  scene::Material single = tests::lambert({1, 0, 0});
  single.doubleSided = false;
  const int front = tests::add(known.scene, tests::quad({-4, -4, 1}, {8, 0, 0}, {0, 8, 0}), single);
  expectEverywhere(render(known), {3 / pi, 0, 0}, storedAsFloat);

  known.scene.instances[front].worldFromObject = glm::dmat4(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 2, 1);
  expectEverywhere(render(known), glm::dvec3(0), storedAsFloat);  // unseen, but it shadows the wall
  known.scene.lights[0].castsShadow = false;
  expectEverywhere(render(known), glm::dvec3(0.5 * 3 / pi), storedAsFloat);

  known.scene.materials.back().doubleSided = true;  // its normal is turned to the viewer
  expectEverywhere(render(known), {3 / pi, 0, 0}, storedAsFloat);

  // Mirrored: what counts is the winding in the world, so the mesh must be wound the other way.
  known.scene.materials.back().doubleSided = false;
  known.scene.instances[front].worldFromObject = glm::dmat4(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1);
  expectEverywhere(render(known), glm::dvec3(0.5 * 3 / pi), storedAsFloat);
  std::ranges::reverse(known.scene.meshes.back().indices);
  expectEverywhere(render(known), {3 / pi, 0, 0}, storedAsFloat);
}

TEST(Reference, LightFromBehindTheSeenSideDoesNothing) {
  KnownScene known = tests::veilsOverWall();
  known.scene.instances.erase(known.scene.instances.begin());  // the wall
  known.scene.lights = {tests::directionalLight({0, 0, 1}, {3, 3, 3})};
  expectEverywhere(render(known), glm::dvec3(0), 0);
}

// A shading normal that leans over to a light below the horizon of the triangle gathers nothing from it.
TEST(Reference, LightBelowTheTrianglesHorizonDoesNothing) {
  KnownScene known = tests::veilsOverWall();
  known.scene.instances.resize(1);
  for (scene::Vertex& vertex : known.scene.meshes[0].vertices) vertex.normal = {0.8f, 0, 0.6f};
  known.scene.lights = {tests::directionalLight({-0.8, 0, 0.6}, {3, 3, 3})};
  known.scene.lights[0].castsShadow = false;
  expectEverywhere(render(known), glm::dvec3(0), 0);
  known.scene.lights[0].direction = {-0.8, 0, -0.6};
  expectEverywhere(render(known), glm::dvec3(0.5 * 3 / pi), storedAsFloat);
}

TEST(Reference, WhatIsBehindALightShadowsNothingOfIt) {
  KnownScene known = tests::planeUnderPointLight();  // the light at y = 2, the camera at 3
  const image::Image expected = render(known);
  tests::add(known.scene, tests::quad({-4, 4, 4}, {8, 0, 0}, {0, 0, -8}), tests::lambert({1, 1, 1}));
  known.media = {tests::block({-4, 4, -4}, {4, 5, 4}, {4, 4, 4}, 5, {1, 1, 1}, 0)};
  EXPECT_EQ(render(known).values, expected.values);
}

TEST(Reference, WhatIsNearerOrFartherIsNotSeen) {
  KnownScene known = tests::paneBeforeSmoke();
  scene::Camera& camera = known.scene.cameras[0];  // at z = 2, the pane at 1, the block from 0.5 to -0.5
  camera.nearDistance = 1.25;
  expectEverywhere(render(known), scatteredByBlock() + std::exp(-1.5) * wallRadiance, storedAsFloat);
  camera.nearDistance = 2;  // half of the block
  const glm::dvec3 half = scatteredByBlock() / (1 - std::exp(-1.5)) * (1 - std::exp(-0.75));
  expectEverywhere(render(known), half + std::exp(-0.75) * wallRadiance, 1e-6);
  camera.farDistance = 3.5;  // the wall stands at 4
  expectEverywhere(render(known), half, 1e-6);
  camera.nearDistance = 0.5;
  camera.farDistance = 2;
  expectEverywhere(render(known), paneColour * half, 1e-6);
}

// Perspective: distances count along the view's axis, so that a plane exactly between near and far is all
// seen.
TEST(Reference, PerspectiveDistancesAreDepths) {
  KnownScene known = tests::planeUnderPointLight();
  const image::Image expected = render(known);
  known.scene.cameras[0].nearDistance = 2.999;
  known.scene.cameras[0].farDistance = 3.001;
  EXPECT_EQ(render(known).values, expected.values);
  known.scene.cameras[0].farDistance = 2.9995;
  expectEverywhere(render(known), glm::dvec3(0), 0);
  known.scene.cameras[0].nearDistance = 3.0005;
  known.scene.cameras[0].farDistance = scene::infinity;
  expectEverywhere(render(known), glm::dvec3(0), 0);
}

TEST(Reference, SamplesAreAveragedOverThePixel) {
  const KnownScene known = tests::planeUnderPointLight();
  const image::Image fine = render(known, {.width = width * 3, .height = height * 3});
  const image::Image coarse = render(known, {.width = width, .height = height, .samples = 3});
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      glm::dvec3 mean(0);
      for (int i = 0; i < 9; ++i) mean += at(fine, 3 * x + i % 3, 3 * y + i / 3) / 9.0;
      expectNear(at(coarse, x, y), mean, storedAsFloat);
    }
}

TEST(Reference, TheSameBitsEveryTime) {
  const KnownScene known = tests::smokeAndGlass();
  const ReferenceOptions options = {.width = 16, .height = 12, .stepVoxels = 2, .shadowStepVoxels = 2};
  EXPECT_EQ(render(known, options).values, render(known, options).values);
}

TEST(Reference, AllKnownScenesHaveLightAndNoNan) {
  for (const KnownScene& known : tests::knownScenes()) {
    const image::Image image =
        render(known, {.width = 8, .height = 6, .stepVoxels = 2, .shadowStepVoxels = 2});
    double sum = 0;
    for (const float value : image.values) {
      ASSERT_TRUE(std::isfinite(value) && value >= 0) << known.name;
      sum += value;
    }
    EXPECT_GT(sum, 0) << known.name;
  }
}

TEST(Reference, AnEmptySceneIsBlack) {
  KnownScene known;
  known.scene.cameras.emplace_back();
  known.scene.lights = {tests::directionalLight({0, -1, 0}, {1, 1, 1}),
                        tests::pointLight({0, 0, 0}, {1, 1, 1})};
  expectEverywhere(render(known), glm::dvec3(0), 0);
}

TEST(Reference, RefusesStepsOfZero) {
  const KnownScene known = tests::planeUnderPointLight();
  EXPECT_THROW(render(known, {.stepVoxels = 0}), base::Error);
}

}  // namespace
}  // namespace sfumato::pipelines
