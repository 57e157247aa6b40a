#include "tests/pipelines/thesis_scenes.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "base/random.h"

namespace sfumato::tests {

using glm::vec3;
using scene::Material;
using scene::Mesh;
using scene::Scene;
using scene::Texture;
using scene::Vertex;
using volumes::Medium;

namespace {

constexpr double pi = std::numbers::pi;

// One mesh of two.
Mesh joined(Mesh mesh, const Mesh& other) {
  const auto first = static_cast<uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const uint32_t index : other.indices) mesh.indices.push_back(first + index);
  return mesh;
}

Mesh coloured(Mesh mesh, const vec3& colour) {
  for (Vertex& vertex : mesh.vertices) vertex.colour = glm::vec4(colour, 1);
  return mesh;
}

// Level, facing up, its middle at (x, y, 0).
Mesh levelPane(float x, float y, float side) {
  return quad({x - side / 2, y, side / 2}, {side, 0, 0}, {0, 0, -side});
}

void addFloor(Scene& scene, const vec3& colour = {1, 1, 1}, float half = 4) {
  add(scene, quad({-half, 0, half}, {2 * half, 0, 0}, {0, 0, -2 * half}), lambert(colour));
}

// What hangs over it is behind the camera.
KnownScene floorInSun(const char* name) {
  KnownScene known{name, {}, {}};
  addFloor(known.scene);
  known.scene.lights.push_back(directionalLight({0, -1, 0}, {3, 3, 3}));
  known.scene.cameras.push_back(orthographicCamera({0, 0.75, 0}, {0, 0, 0}, 1.5, {0, 0, -1}));
  return known;
}

glm::dmat4 placed(const glm::dvec3& position, double scale) {
  return glm::scale(glm::translate(glm::dmat4(1), position), glm::dvec3(scale));
}

// A cloth of `folds` waves that hangs from (0, height, 0) along x.
Mesh cloth(float width, float height, float folds) {
  constexpr int columns = 48;
  constexpr float depth = 0.08f;
  Mesh mesh;
  for (int row = 0; row <= 1; ++row)
    for (int column = 0; column <= columns; ++column) {
      const float u = static_cast<float>(column) / columns;
      const float phase = 2 * static_cast<float>(pi) * folds * u;
      const float slope = depth * 2 * static_cast<float>(pi) * folds / width * std::cos(phase);
      Vertex vertex;
      vertex.position = {width * (u - 0.5f), height * static_cast<float>(row), depth * std::sin(phase)};
      vertex.normal = glm::normalize(vec3(-slope, 0, 1));
      mesh.vertices.push_back(vertex);
    }
  for (uint32_t lower = 0; lower < columns; ++lower) {
    const uint32_t upper = lower + columns + 1;
    mesh.indices.insert(mesh.indices.end(), {lower, lower + 1, upper + 1, lower, upper + 1, upper});
  }
  return mesh;
}

// Lets light of its colour through, and reflects it.
Material fabric(const vec3& colour) {
  Material material = veil(colour, 0.95f);
  material.transmission = 0.6f;
  return material;
}

Medium turnedBy(Medium medium, const glm::dmat4& worldFromMedium) {
  medium.worldFromIndex = worldFromMedium * medium.worldFromIndex;
  medium.grid.worldFromIndex = medium.worldFromIndex;
  return medium;
}

}  // namespace

KnownScene panesOfOneObjectAndOfTwo() {
  KnownScene known = floorInSun("panes of one object and of two");
  Material glass = pane({0.5f, 0.25f, 0.75f});
  glass.shadowOnce = true;
  add(known.scene, joined(levelPane(-1, 1, 1), levelPane(-1, 2, 1)), glass);
  add(known.scene, levelPane(1, 1, 1), glass);
  add(known.scene, levelPane(1, 2, 1), glass);
  return known;
}

KnownScene redPaneOverBluePane() {
  KnownScene known = floorInSun("red pane over blue pane");
  Material glass = pane({1, 1, 1});
  glass.shadowOnce = true;
  add(known.scene,
      joined(coloured(levelPane(0, 1, 2), {0.2f, 0.3f, 0.9f}),
             coloured(levelPane(0.5f, 2, 2), {0.9f, 0.2f, 0.1f})),
      glass);
  return known;
}

KnownScene glassBall(float rim) {
  KnownScene known = floorInSun(rim > 0 ? "glass ball with a rim" : "glass ball");
  Material glass = pane({0.9f, 0.8f, 0.6f});
  glass.shadowRim = rim;
  add(known.scene, sphere(96, 192), glass, placed({0, 2, 0}, 1));
  return known;
}

KnownScene lShape(bool shadowSelf) {
  KnownScene known{shadowSelf ? "L shape" : "L shape that does not shadow itself", {}, {}};
  addFloor(known.scene);
  Material stone = lambert({0.75f, 0.5f, 0.25f});
  stone.shadowSelf = shadowSelf;
  add(known.scene, joined(box({-0.2f, 0, -1}, {0, 1, 1}), box({0, 0, -1}, {0.5f, 0.25f, 1})), stone);
  known.scene.lights.push_back(directionalLight({1, -1, 0}, {3, 3, 3}));
  known.scene.cameras.push_back(orthographicCamera({0.25, 3, 0}, {0.25, 0, 0}, 1.2, {0, 0, -1}));
  return known;
}

KnownScene flagsInSmoke() {
  KnownScene known{"flags in smoke", {}, {}};
  Scene& scene = known.scene;
  addFloor(scene, {0.6f, 0.6f, 0.55f}, 6);
  add(scene, quad({-6, 0, -2.5f}, {12, 0, 0}, {0, 6, 0}), lambert({0.5f, 0.5f, 0.55f}));
  Material stone = lambert({0.7f, 0.4f, 0.25f});
  stone.shadowSelf = false;
  add(scene, joined(box({-2.2f, 0, -0.7f}, {-1.9f, 1.6f, 0.7f}), box({-1.9f, 0, -0.7f}, {-1, 0.4f, 0.7f})),
      stone);
  Material shade = fabric({0.2f, 0.7f, 0.4f});
  shade.shadowSelf = false;
  add(scene, cloth(1.4f, 1.5f, 3), shade, glm::translate(glm::dmat4(1), glm::dvec3(1.3, 0.2, 0.3)));
  Material glass = pane({0.9f, 0.5f, 0.3f});
  glass.shadowOnce = true;
  glass.shadowRim = 0.5f;
  add(scene, sphere(32, 64), glass, placed({0, 1.2, 0.6}, 0.5));
  Material both = veil({0.3f, 0.3f, 0.9f}, 0.5f);
  both.shadowOnce = true;
  both.shadowSelf = false;
  add(scene, box({-0.9f, 0.1f, 1}, {-0.3f, 0.7f, 1.6f}), both);
  known.media.push_back(ball({0.2, 1.2, 0}, 1.2, 24, 2.5, {0.9, 0.9, 0.9}, 0.3));
  scene.lights.push_back(spotLight({-3.5, 4.5, 2.5}, {0, 0.8, 0}, {120, 110, 100}, 0.35, 0.5));
  scene.lights.push_back(pointLight({2.4, 1.4, 1.8}, {9, 8, 7}));
  scene.lights.back().range = 6;
  scene.lights.push_back(directionalLight({-0.3, -1, -0.6}, {0.4, 0.45, 0.5}));
  scene.cameras.push_back(perspectiveCamera({0.4, 2, 6.5}, {0, 0.9, 0}, 0.6));
  return known;
}

KnownScene curtainsBeforeLamp() {
  KnownScene known{"curtains before a lamp", {}, {}};
  Scene& scene = known.scene;
  addFloor(scene, {0.6f, 0.6f, 0.6f}, 5);
  const vec3 colours[] = {{0.8f, 0.15f, 0.1f}, {0.15f, 0.6f, 0.2f}, {0.15f, 0.25f, 0.8f}};
  for (int i = 0; i < 3; ++i) {
    const glm::dmat4 turned = glm::rotate(glm::dmat4(1), (i - 1) * 1.1, glm::dvec3(0, 1, 0));
    add(scene, cloth(1.4f, 1.8f, 4), fabric(colours[i]), glm::translate(turned, glm::dvec3(0, 0, 1.3)));
  }
  scene.lights.push_back(pointLight({0, 1, 0}, {12, 12, 11}));
  scene.cameras.push_back(perspectiveCamera({1, 3.5, 6}, {0, 0.4, 1}, 0.7));
  return known;
}

KnownScene curtainUnderSpot() {
  KnownScene known{"curtain under a spot", {}, {}};
  Scene& scene = known.scene;
  addFloor(scene, {0.6f, 0.6f, 0.6f}, 5);
  add(scene, quad({-5, 0, -2}, {10, 0, 0}, {0, 4, 0}), lambert({0.7f, 0.7f, 0.65f}));
  add(scene, cloth(2, 2, 5), fabric({0.85f, 0.3f, 0.1f}),
      glm::translate(glm::dmat4(1), glm::dvec3(0, 0.3, 0)));
  scene.lights.push_back(spotLight({1.5, 2.5, 4}, {0, 1.2, 0}, {90, 90, 85}, 0.25, 0.35));
  scene.cameras.push_back(perspectiveCamera({-2, 2, 5}, {0, 1, -0.8}, 0.7));
  return known;
}

KnownScene rotatedCube() {
  KnownScene known{"rotated cube", {}, {}};
  addFloor(known.scene, {0.8f, 0.8f, 0.8f});
  const glm::dmat4 onEdge =
      glm::rotate(glm::translate(glm::dmat4(1), glm::dvec3(0, 1.2, 0)), pi / 4, glm::dvec3(0, 0, 1));
  known.media = {
      turnedBy(block({-0.6, -0.6, -0.6}, {0.6, 0.6, 0.6}, glm::ivec3(24), 1.5, {0.8, 0.8, 0.8}, 0), onEdge)};
  known.scene.lights.push_back(directionalLight({0, -1, 0}, {3, 3, 3}));
  known.scene.cameras.push_back(perspectiveCamera({0, 2.2, 4.5}, {0, 0.7, 0}, 0.7));
  return known;
}

KnownScene staircase() {
  KnownScene known{"staircase", {}, {}};
  addFloor(known.scene, {0.8f, 0.8f, 0.8f});
  Medium steps = block({-0.9, 0.5, -0.5}, {0.9, 1.7, 0.5}, {36, 24, 20}, 1.2, {0.8, 0.8, 0.8}, 0);
  volumes::DensityGrid& grid = steps.grid;
  for (int x = 0; x < grid.size.x; ++x)
    for (int y = 0; y < grid.size.y; ++y)
      for (int z = 0; z < grid.size.z; ++z)
        if ((y - 1) / 8 > (x - 1) / 12) grid.values[grid.valueIndex(x, y, z)] = 0;
  known.media = {steps};
  known.scene.lights.push_back(directionalLight({0, -1, 0}, {3, 3, 3}));
  known.scene.cameras.push_back(perspectiveCamera({-0.4, 2.6, 4.2}, {0, 0.6, 0}, 0.7));
  return known;
}

KnownScene slideProjector() {
  KnownScene known{"slide projector", {}, {}};
  Scene& scene = known.scene;
  add(scene, quad({-3, -2, -2}, {6, 0, 0}, {0, 4, 0}), lambert({0.9f, 0.9f, 0.9f}));
  Texture slide;
  slide.width = slide.height = 4;
  slide.nearest = true;
  base::Random random(11);
  for (int texel = 0; texel < 16; ++texel) {
    for (int c = 0; c < 3; ++c) slide.rgba.push_back(random.uniform() < 0.5 ? 0 : 255);
    slide.rgba.push_back(255);
  }
  scene.textures.push_back(slide);
  Material film = pane({0.9f, 0.7f, 0.8f});
  film.baseColourTexture.texture = 0;
  add(scene, quad({-0.4f, -0.4f, 1}, {0.8f, 0, 0}, {0, 0.8f, 0}), film);
  scene.lights.push_back(spotLight({0, 0, 2}, {0, 0, 0}, {60, 60, 60}, 0.45, 0.5));
  scene.cameras.push_back(perspectiveCamera({1.5, 0.5, 2.2}, {-0.2, 0, -2}, 0.9));
  return known;
}

KnownScene smokeCrossedByGeometry() {
  KnownScene known{"smoke crossed by geometry", {}, {}};
  Scene& scene = known.scene;
  addFloor(scene, {0.6f, 0.6f, 0.6f}, 5);
  add(scene, quad({-5, 0, -2}, {10, 0, 0}, {0, 4, 0}), lambert({0.6f, 0.6f, 0.6f}));
  add(scene, box({-0.9f, 0, -0.15f}, {-0.6f, 2.4f, 0.15f}), lambert({0.8f, 0.7f, 0.5f}));
  add(scene, box({0.3f, 0.9f, -1.4f}, {0.5f, 1.1f, 1.4f}), lambert({0.5f, 0.6f, 0.8f}));
  add(scene, quad({0, 0.6f, 0.4f}, {0.9f, 0, 0.3f}, {0, 1, 0}), pane({0.9f, 0.4f, 0.2f}));
  known.media.push_back(ball({0, 1.1, 0}, 1.1, 24, 3, {0.9, 0.9, 0.9}, 0.2));
  scene.lights.push_back(spotLight({2.5, 4, 2.5}, {0, 1, 0}, {90, 85, 80}, 0.35, 0.5));
  scene.cameras.push_back(perspectiveCamera({0.3, 1.6, 5}, {0, 1, 0}, 0.7));
  return known;
}

KnownScene lampInSmoke() {
  KnownScene known{"lamp in smoke", {}, {}};
  addFloor(known.scene, {0.7f, 0.7f, 0.7f});
  add(known.scene, quad({-4, 0, -2}, {8, 0, 0}, {0, 4, 0}), lambert({0.6f, 0.6f, 0.6f}));
  add(known.scene, box({0.5f, 1.2f, -0.2f}, {0.7f, 1.4f, 0.2f}), lambert({0.6f, 0.6f, 0.6f}));
  known.media = {ball({0, 1.2, 0}, 1.1, 32, 3, {0.9, 0.9, 0.9}, 0)};
  known.scene.lights.push_back(pointLight({0, 1, 0}, {4, 4, 4}));
  known.scene.cameras.push_back(perspectiveCamera({0, 1.6, 4.5}, {0, 1, 0}, 0.7));
  return known;
}

KnownScene cameraInSmoke() {
  KnownScene known = smokeCrossedByGeometry();
  known.name = "camera in smoke";
  known.scene.cameras[0] = perspectiveCamera({-0.2, 1.3, 0.5}, {0.3, 0.9, -1.5}, 1.1);
  return known;
}

KnownScene cameraInManyLights() {
  KnownScene known{"camera in many lights", {}, {}};
  Scene& scene = known.scene;
  addFloor(scene, {0.6f, 0.6f, 0.6f}, 5);
  add(scene, box({-0.4f, 0, -0.4f}, {0.4f, 0.8f, 0.4f}), lambert({0.7f, 0.7f, 0.7f}));
  base::Random random(3);
  for (int i = 0; i < 60; ++i) {
    const auto between = [&](double low, double high) { return random.uniform(low, high); };
    const glm::dvec3 position{between(-3, 3), between(0.3, 1.8), between(-3, 3)};
    const glm::dvec3 colour{between(0, 1), between(0, 1), between(0, 1)};
    scene.lights.push_back(i % 3 == 2 ? spotLight(position, {0, 0, 0}, colour, 0.3, 0.6)
                                      : pointLight(position, colour * 0.5));
    scene.lights.back().range = random.uniform(1, 4);
  }
  // Beside a lamp in smoke no number of steps is enough: none is.
  add(scene, quad({-1.2f, 0.2f, 0.5f}, {0.6f, 0, 0.2f}, {0, 0.7f, 0}), pane({0.5f, 0.8f, 0.9f}));
  scene.cameras.push_back(perspectiveCamera({1, 1.2, 1.4}, {-0.5, 0.2, -1}, 0.9));
  return known;
}

std::vector<KnownScene> thesisScenes() {
  return {panesOfOneObjectAndOfTwo(),
          redPaneOverBluePane(),
          glassBall(0),
          glassBall(1),
          lShape(true),
          lShape(false),
          flagsInSmoke(),
          curtainsBeforeLamp(),
          curtainUnderSpot(),
          rotatedCube(),
          staircase(),
          slideProjector(),
          smokeCrossedByGeometry(),
          lampInSmoke(),
          cameraInSmoke(),
          cameraInManyLights()};
}

namespace {

// The light's direction turns about the vertical as well, so that it is along no axis of the geometry.
scene::Light sunAt(double elevation) {
  const double azimuth = 0.4;
  const double level = std::cos(elevation);
  return directionalLight({level * std::cos(azimuth), -std::sin(elevation), level * std::sin(azimuth)},
                          {3, 3, 3});
}

}  // namespace

KnownScene floorAtAngle(double elevation) {
  KnownScene known{"floor at an angle", {}, {}};
  addFloor(known.scene);
  known.scene.lights = {sunAt(elevation)};
  known.scene.cameras = {perspectiveCamera({0, 1.5, 4}, {0, 0, 0}, 0.8)};
  return known;
}

KnownScene ballAtAngle(double elevation) {
  KnownScene known = floorAtAngle(elevation);
  known.name = "ball at an angle";
  Material closed = lambert({1, 1, 1});
  closed.doubleSided = false;
  add(known.scene, sphere(48, 96), closed, placed({0, 0.8, 0}, 0.8));
  return known;
}

KnownScene insideOfClosedBox(const scene::Light& lightOutside, float thickness) {
  KnownScene known{"inside of a closed box", {}, {}};
  const float out = 1 + thickness;
  add(known.scene, box({-1, 0, -1}, {1, 2, 1}), lambert({1, 1, 1}));
  if (thickness > 0) add(known.scene, box({-out, -thickness, -out}, {out, 1 + out, out}), lambert({1, 1, 1}));
  add(known.scene, box({-0.5f, 0, -0.5f}, {0, 0.5f, 0}), lambert({1, 1, 1}));
  known.scene.lights = {lightOutside};
  known.scene.cameras = {perspectiveCamera({0.8, 1.5, 0.9}, {-0.2, 0.4, -0.3}, 1.6)};
  return known;
}

KnownScene outsideOfClosedBox() {
  KnownScene known{"outside of a closed box", {}, {}};
  addFloor(known.scene);
  add(known.scene, box({-1, 0.2f, -1}, {1, 2, 1}), lambert({1, 1, 1}));
  known.scene.lights = {pointLight({0.3, 1.1, -0.2}, {30, 30, 30})};
  known.scene.cameras = {perspectiveCamera({2, 3, 5}, {0, 0.5, 0}, 0.9)};
  return known;
}

}  // namespace sfumato::tests
