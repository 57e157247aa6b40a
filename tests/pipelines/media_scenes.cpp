#include "tests/pipelines/media_scenes.h"

#include <cmath>
#include <numbers>

#include "scene/fire_lights.h"
#include "volumes/fire.h"

namespace sfumato::tests {
namespace {

KnownScene wallBehind(const std::string& name) {
  KnownScene known{name, {}, {}};
  add(known.scene, quad({-4, -4, -2}, {8, 0, 0}, {0, 8, 0}), glowing({0.5f, 1, 2}));
  known.scene.cameras.push_back(orthographicCamera({0, 0, 2}, {0, 0, 0}, 1));
  return known;
}

volumes::Medium slab(double sigmaT, const glm::dvec3& colour, const glm::dvec3& albedo, double g) {
  volumes::Medium medium = block({-4, -4, -0.5}, {4, 4, 0.5}, {4, 4, 16}, sigmaT, albedo, g);
  medium.extinctionColour = colour;
  return medium;
}

// Emits (3, 2, 1) per metre where the block has the density 1.
volumes::Fire evenFire(const volumes::Medium& block) {
  return volumes::makeFire(block.grid, block.worldFromIndex, {.ramp = {{0, 0, 0}, {3, 2, 1}}}, "test");
}

}  // namespace

KnownScene colouredSlab() {
  KnownScene known = wallBehind("coloured slab");
  known.media = {slab(1.5, {1, 0.5, 0}, glm::dvec3(0.9), 0)};
  return known;
}

KnownScene overlappingColours() {
  KnownScene known = wallBehind("overlapping colours");
  known.media = {slab(1.5, {1, 0.5, 0}, {0.9, 0.6, 0.3}, 0.4),
                 slab(0.5, {0.25, 4, 0}, {0.2, 0.4, 0.8}, -0.3)};
  known.scene.lights.push_back(directionalLight({3, 0, -4}, {4, 5, 6}));
  known.scene.lights.back().castsShadow = false;
  return known;
}

KnownScene colouredShadow() {
  KnownScene known = smokeOverFloor();
  known.name = "coloured shadow";
  known.media[0].extinctionColour = {0, 0.5, 2};
  return known;
}

KnownScene colouredBalls() {
  KnownScene known{"coloured balls", {}, {}};
  scene::Scene& scene = known.scene;
  add(scene, quad({-6, 0, 6}, {12, 0, 0}, {0, 0, -12}), lambert({0.6f, 0.6f, 0.6f}));
  add(scene, quad({-6, 0, -2}, {12, 0, 0}, {0, 6, 0}), lambert({0.5f, 0.5f, 0.5f}));
  add(scene, box({-1, 1.2f, 0.4f}, {-0.6f, 1.6f, 0.9f}), lambert({0.3f, 0.5f, 0.7f}));
  add(scene, quad({-0.5f, 0.6f, 1}, {1, 0, -0.3f}, {0, 1.1f, 0}), pane({0.9f, 0.5f, 0.3f}));
  known.media = {ball({-0.4, 1.2, 0}, 1, 24, 5, {0.9, 0.8, 0.7}, 0.3),
                 ball({0.5, 1.4, 0.3}, 0.9, 20, 4, {0.7, 0.9, 0.9}, -0.2)};
  known.media[0].extinctionColour = {1, 0.4, 0.1};
  known.media[1].extinctionColour = {0.2, 0.6, 1.5};
  scene.lights.push_back(spotLight({-3, 4, 3}, {0, 1, 0}, {120, 120, 120}, 0.3, 0.45));
  scene.lights.push_back(pointLight({1.9, 0.9, 1.6}, {8, 8, 8}));
  scene.lights.push_back(directionalLight({0.3, -1, -0.8}, {0.5, 0.5, 0.5}));
  scene.cameras.push_back(perspectiveCamera({0, 1.6, 5.5}, {0, 1.2, 0}, 0.6));
  return known;
}

KnownScene furnace(int lights) {
  KnownScene known{"furnace", {}, {}};
  known.media = {ball({0, 0, 0}, 1, 24, 12, glm::dvec3(1), 0)};
  known.media[0].extinctionColour = {1, 0.3, 0.1};
  for (int i = 0; i < lights; ++i) {
    // Points of a spiral over the sphere, each for an equal part of it.
    const double height = 1 - (2 * i + 1.0) / lights;
    const double angle = i * std::numbers::pi * (3 - std::sqrt(5.0));
    const double away = std::sqrt(1 - height * height);
    known.scene.lights.push_back(directionalLight({away * std::cos(angle), height, away * std::sin(angle)},
                                                  glm::dvec3(4 * std::numbers::pi / lights)));
  }
  known.scene.cameras.push_back(orthographicCamera({0, 0, 3}, {0, 0, 0}, 1.1));
  return known;
}

KnownScene burningSlab() {
  KnownScene known = colouredSlab();
  known.name = "burning slab";
  known.media[0].fire = evenFire(known.media[0]);
  return known;
}

KnownScene fireBehindSmoke() {
  KnownScene known = wallBehind("fire behind smoke");
  known.media = {block({-4, -4, 0.5}, {4, 4, 1.5}, {4, 4, 16}, 0.75, glm::dvec3(0.9), 0)};
  known.media[0].fire = evenFire(block({-4, -4, -1.5}, {4, 4, -0.5}, {4, 4, 20}, 1, glm::dvec3(0), 0));
  return known;
}

KnownScene burningBall() {
  KnownScene known{"burning ball", {}, {}};
  scene::Scene& scene = known.scene;
  add(scene, quad({-6, 0, 6}, {12, 0, 0}, {0, 0, -12}), lambert({0.6f, 0.6f, 0.6f}));
  add(scene, quad({-6, 0, -2}, {12, 0, 0}, {0, 6, 0}), lambert({0.5f, 0.5f, 0.5f}));
  add(scene, box({-0.5f, 1.2f, 0.3f}, {-0.1f, 1.6f, 0.7f}), lambert({0.3f, 0.5f, 0.7f}));
  known.media = {ball({0, 1.3, 0}, 1, 24, 5, glm::dvec3(0.6), 0.3)};
  const volumes::Medium heat = ball({0.2, 1.1, 0}, 0.8, 32, 1, glm::dvec3(0), 0);
  known.media[0].fire =
      volumes::makeFire(heat.grid, heat.worldFromIndex, {.kelvin = 1900.0, .strength = 0.5}, "test");
  scene.lights = scene::fireLights(*known.media[0].fire, 2);
  scene.lights.push_back(directionalLight({0.3, -1, -0.8}, {0.5, 0.5, 0.5}));
  scene.cameras.push_back(perspectiveCamera({0, 1.6, 5.5}, {0, 1.2, 0}, 0.6));
  return known;
}

}  // namespace sfumato::tests
