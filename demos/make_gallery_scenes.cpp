// Writes the scenes of docs/gallery.md into a folder, a .gltf each: the pictures of Lindbeck 2015, chapter 3,
// and those of its faults.
#include <cmath>

#include "base/random.h"
#include "demos/gltf_writer.h"
#include "image/image_file.h"
#include "volumes/procedural_smoke.h"
#include "volumes/vdb_file.h"

namespace sfumato::demos {
namespace {

using glm::vec2;
using glm::vec3;
using nlohmann::json;
namespace fs = std::filesystem;

Gltf newScene() {
  return Gltf("make_gallery_scenes");
}

constexpr vec3 plaster(0.62f, 0.6f, 0.56f);

void addFloor(Gltf& gltf, const vec3& colour = plaster) {
  Shape floor;
  floor.addPlane({-12, 0, 8}, {24, 0, 0}, {0, 0, -24});
  gltf.addShape("floor", floor, gltf.addMaterial({.name = "floor", .colour = colour}));
}

// At z = -`behind`, facing the camera.
void addWall(Gltf& gltf, float behind, const vec3& colour = plaster) {
  Shape wall;
  wall.addPlane({-12, 0, -behind}, {24, 0, 0}, {0, 6, 0});
  gltf.addShape("wall", wall, gltf.addMaterial({.name = "wall", .colour = 0.9f * colour}));
}

void addSky(Gltf& gltf, float irradiance) {
  gltf.addLight("sky", {{"type", "directional"}, {"color", {0.6, 0.75, 1}}, {"intensity", irradiance}},
                lookingAt({0.4f, 3, 1.4f}, {0, 0, 0}));
}

void addSun(Gltf& gltf, float irradiance, const vec3& from) {
  gltf.addLight("sun", {{"type", "directional"}, {"color", {1, 0.93, 0.82}}, {"intensity", irradiance}},
                lookingAt(from, {0, 0, 0}));
}

void addSpot(Gltf& gltf, float intensity, const vec3& eye, const vec3& target, float inner, float outer) {
  gltf.addLight("spot",
                {{"type", "spot"},
                 {"color", {1, 0.96, 0.9}},
                 {"intensity", intensity},
                 {"spot", {{"innerConeAngle", inner}, {"outerConeAngle", outer}}}},
                lookingAt(eye, target));
}

void addLamp(Gltf& gltf, const vec3& position, const vec3& colour, float intensity) {
  gltf.addLight("lamp", {{"type", "point"}, {"color", toJson(colour)}, {"intensity", intensity}},
                at(position));
}

void addSmoke(Gltf& gltf, const char* file, float scale, json placement, const vec3& albedo, float g,
              const json& more = json::object()) {
  placement["extras"] = {
      {"volume", file}, {"volume_scale", scale}, {"volume_albedo", toJson(albedo)}, {"volume_g", g}};
  placement["extras"].update(more);
  gltf.addNode("smoke", placement);
}

Shape ball(const vec3& centre, float radius) {
  Shape shape;
  shape.addBall(centre, radius);
  return shape;
}

Shape column(const vec3& foot, float height, float radius) {
  Shape shape;
  const vec3 half(1.5f * radius, 0, 1.5f * radius);
  const vec3 block(0, 1.2f * radius, 0);
  shape.addTube(foot + block, height - 2 * block.y, radius, 0.88f * radius);
  shape.addBox(foot - half, foot + half + block);
  shape.addBox(foot - half + vec3(0, height, 0) - block, foot + half + vec3(0, height, 0));
  return shape;
}

// Hangs from y = height, looking along its +Z, its folds wider towards the hem.
Shape cloth(float width, float height, float folds) {
  Shape shape;
  shape.addSurface(128, 32, [=](float u, float v) {
    const float fold =
        std::sin(2 * pi * folds * u + 0.8f * std::sin(2.5f * v)) + 0.3f * std::sin(7 * u + 2 * v);
    return vec3(width * (u - 0.5f), height * (1 - v), (0.03f + 0.04f * v) * fold);
  });
  return shape;
}

// A tube along a curve in the plane z = 0.
template <typename Centre, typename Radius>
void addPipe(Shape& shape, const Centre& centre, const Radius& radius) {
  shape.addSurface(32, 48, [=](float u, float v) {
    constexpr float step = 1e-3f;
    const vec2 along = glm::normalize(centre(v + step) - centre(v - step));
    const float angle = 2 * pi * u;
    const vec3 across(-along.y, along.x, 0);
    return vec3(centre(v), 0) + radius(v) * (std::cos(angle) * across + std::sin(angle) * vec3(0, 0, 1));
  });
}

// A pot with a lid, a spout to the right and a handle to the left; about 0.6 m high.
Shape teapot() {
  Shape shape;
  const auto turnedSurface = [&](const auto& profile) {
    shape.addSurface(128, 64, [=](float u, float v) {
      const vec2 p = profile(v);  // radius, height
      return vec3(p.x * std::sin(2 * pi * u), p.y, p.x * std::cos(2 * pi * u));
    });
  };
  turnedSurface([](float v) {
    const float angle = pi * (0.24f + 0.68f * v);
    return vec2(0.42f * std::sin(angle), 0.29f + 0.29f * std::cos(angle));
  });
  turnedSurface([](float v) {
    const float angle = 0.5f * pi * v;
    return vec2(0.001f + 0.28f * std::sin(angle), 0.5f + 0.06f * std::cos(angle));
  });
  shape.addBall({0, 0.6f, 0}, 0.045f);
  addPipe(
      shape, [](float v) { return vec2(0.37f + 0.33f * v, 0.2f + 0.32f * v * v * (1.5f - 0.5f * v)); },
      [](float v) { return 0.075f - 0.04f * v; });
  addPipe(
      shape,
      [](float v) {
        const float angle = pi * (0.5f + v);
        return vec2(-0.33f + 0.28f * std::cos(angle), 0.32f + 0.14f * std::sin(angle));
      },
      [](float) { return 0.03f; });
  return shape;
}

// A box of density 1 in [0, 1]^3 metres of `voxels` voxels a side, where `inside` says so; a margin of 0
// around.
template <typename Inside>
volumes::DensityGrid voxelise(int voxels, const Inside& inside) {
  volumes::DensityGrid grid;
  grid.name = "density";
  grid.size = glm::ivec3(voxels + 2);
  grid.values.assign(static_cast<size_t>(grid.size.x) * grid.size.y * grid.size.z, 0.f);
  const double side = 1.0 / voxels;
  for (int z = 0; z < voxels; ++z)
    for (int y = 0; y < voxels; ++y)
      for (int x = 0; x < voxels; ++x)
        if (inside((vec3(x, y, z) + 0.5f) * static_cast<float>(side)))
          grid.values[grid.valueIndex(x + 1, y + 1, z + 1)] = 1;
  grid.worldFromIndex =
      glm::dmat4(side, 0, 0, 0, 0, side, 0, 0, 0, 0, side, 0, -side / 2, -side / 2, -side / 2, 1);
  return grid;
}

// Three curtains between columns, that hang at z = 0.
Gltf curtainScene() {
  Gltf gltf = newScene();
  addFloor(gltf);
  addWall(gltf, 2.5f);
  const size_t stone = gltf.addMaterial({.name = "stone", .colour = {0.6f, 0.57f, 0.5f}});
  for (int i = 0; i < 4; ++i)
    gltf.addShape("column", column({1.5f * static_cast<float>(i) - 2.25f, 0, 0}, 2.6f, 0.14f), stone);
  Shape beam;
  beam.addBox({-2.6f, 2.6f, -0.2f}, {2.6f, 2.8f, 0.2f});
  gltf.addShape("beam", beam, stone);
  const vec3 colours[] = {{0.8f, 0.1f, 0.08f}, {0.12f, 0.5f, 0.16f}, {0.1f, 0.2f, 0.75f}};
  const Shape curtain = cloth(1.15f, 2.3f, 5);
  for (int i = 0; i < 3; ++i)
    gltf.addShape(
        "curtain", curtain,
        gltf.addMaterial({.name = "fabric", .colour = colours[i], .alpha = 0.95f, .transmission = 0.75f}),
        at({1.5f * static_cast<float>(i) - 1.5f, 0.25f, 0}));
  addSky(gltf, 0.15f);
  gltf.addCamera("camera", 0.62f, lookingAt({0.7f, 2.2f, 5.6f}, {0, 0.95f, 0}));
  return gltf;
}

// Figure 3.1, with a point light.
void makeCurtains(const fs::path& folder) {
  Gltf gltf = curtainScene();
  addLamp(gltf, {0.2f, 1.3f, -1.2f}, {1, 0.93f, 0.82f}, 30);
  gltf.write(folder / "curtains.gltf");
}

// The same with a spot, from the other side.
void makeCurtainsInSpot(const fs::path& folder) {
  Gltf gltf = curtainScene();
  addSpot(gltf, 420, {-2.6f, 3.3f, 4.4f}, {0, 1.1f, -0.4f}, 0.36f, 0.44f);
  gltf.write(folder / "curtains_in_spot.gltf");
}

// Figure 3.2.
void makeVolumes(const fs::path& folder) {
  constexpr int voxels = 60;
  volumes::writeVdb(folder / "cube.vdb", voxelise(voxels, [](const vec3&) { return true; }));
  volumes::writeVdb(folder / "staircase.vdb", voxelise(voxels, [](const vec3& p) {
                      return std::abs(p.z - 0.5f) < 0.25f && p.y < (std::floor(3 * p.x) + 1) / 3;
                    }));
  Gltf gltf = newScene();
  addFloor(gltf);
  json stairs = at({-1.75f, 0.6f, -0.6f});
  stairs["scale"] = {1.4, 1, 1.2};
  addSmoke(gltf, "staircase.vdb", 1.6f, stairs, {0.7f, 0.75f, 0.8f}, 0);
  // On its edge: turned by 45 degrees about Z.
  json cube = at({1.05f, 0.55f, -0.5f});
  cube["rotation"] = {0, 0, std::sin(pi / 8), std::cos(pi / 8)};
  addSmoke(gltf, "cube.vdb", 1.6f, cube, {0.7f, 0.75f, 0.8f}, 0);
  addSun(gltf, 3.4f, {0.001f, 5, 0.001f});
  gltf.addCamera("camera", 0.6f, lookingAt({-0.1f, 3.6f, 4.6f}, {-0.05f, 0.5f, -0.2f}));
  gltf.write(folder / "volumes.gltf");
}

// Figure 3.3.
void makeSmoke(const fs::path& folder) {
  Gltf gltf = newScene();
  addFloor(gltf);
  addWall(gltf, 1.6f);
  Shape plinth;
  plinth.addBox({-0.3f, 0, -0.3f}, {0.3f, 0.35f, 0.3f});
  gltf.addShape("plinth", plinth, gltf.addMaterial({.name = "stone", .colour = {0.5f, 0.48f, 0.45f}}));
  json smoke = at({0, 0.3f, 0});
  smoke["scale"] = {1.1, 1.1, 1.1};
  addSmoke(gltf, "plume.vdb", 9, smoke, {0.92f, 0.92f, 0.94f}, 0.2f);
  addSpot(gltf, 130, {-3.4f, 2.6f, 3.2f}, {0.1f, 1.3f, 0}, 0.3f, 0.42f);
  addSky(gltf, 0.12f);
  gltf.addCamera("camera", 0.62f, lookingAt({-1.1f, 1.5f, 5.2f}, {0.5f, 1.3f, 0}));
  gltf.write(folder / "smoke.gltf");
}

// Light through smoke: slats cut the beam of a spot into blades.
void makeBlades(const fs::path& folder) {
  Gltf gltf = newScene();
  addFloor(gltf);
  addWall(gltf, 1.8f);
  Shape slats;
  for (int i = 0; i < 7; ++i) {
    const float y = 0.9f + 0.26f * static_cast<float>(i);
    slats.addBox({-1.85f, y, -0.9f}, {-1.8f, y + 0.13f, 0.9f});
  }
  gltf.addShape("slats", slats, gltf.addMaterial({.name = "wood", .colour = {0.3f, 0.2f, 0.12f}}));
  json smoke = at({0.1f, 0, 0});
  smoke["scale"] = {2.2, 1.25, 1.6};
  addSmoke(gltf, "plume.vdb", 2.2f, smoke, {0.95f, 0.95f, 0.95f}, 0.4f);
  addSpot(gltf, 320, {-4.2f, 3.1f, 0.3f}, {0, 1.35f, 0}, 0.3f, 0.36f);
  addSky(gltf, 0.1f);
  gltf.addCamera("camera", 0.62f, lookingAt({0.9f, 1.6f, 5}, {-0.1f, 1.35f, 0}));
  gltf.write(folder / "blades.gltf");
}

// Figure 3.4: as it is, and with the way through a shell counted.
void makeTeapots(const fs::path& folder) {
  Gltf gltf = newScene();
  addFloor(gltf, {0.75f, 0.74f, 0.72f});
  const Shape pot = teapot();
  const vec3 colour(0.8f, 0.87f, 0.84f);
  gltf.addShape("teapot", pot,
                gltf.addMaterial({.name = "glass", .colour = colour, .roughness = 0.08f, .transmission = 1}),
                at({-0.8f, 0.01f, 0.1f}));
  gltf.addShape("teapot with a rim", pot,
                gltf.addMaterial({.name = "glass with a rim",
                                  .colour = colour,
                                  .roughness = 0.08f,
                                  .transmission = 1,
                                  .extras = {{"shadow_rim", 1}}}),
                at({0.7f, 0.01f, 0.1f}));
  addSun(gltf, 3.6f, {-1, 1.6f, -0.9f});
  gltf.addCamera("camera", 0.48f, lookingAt({0.1f, 2, 3.6f}, {0.05f, 0.2f, 0.25f}));
  gltf.write(folder / "teapots.gltf");
}

// A rose window: petals around a disc, leaded.
image::Image roseWindow() {
  constexpr int side = 256;
  image::Image picture(side, side, 3);
  const vec3 glass[] = {
      {0.9f, 0.08f, 0.06f}, {0.06f, 0.12f, 0.75f}, {0.85f, 0.5f, 0.05f}, {0.05f, 0.5f, 0.15f}};
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const vec2 p = (vec2(x, y) + 0.5f) * (2.f / side) - 1.f;
      const float radius = glm::length(p);
      const float turn = std::atan2(p.y, p.x) / (2 * pi) + 0.5f;
      const float ring = std::floor(radius * 3.2f);
      const float petals = ring < 1 ? 1.f : 6.f * ring;
      const float across = turn * petals - std::floor(turn * petals);
      const bool lead = std::abs(radius * 3.2f - std::round(radius * 3.2f)) < 0.07f || radius > 0.94f ||
                        (ring >= 1 && (0.5f - std::abs(across - 0.5f)) * 2 * pi * radius / petals < 0.02f);
      const int colour = static_cast<int>(ring + std::floor(turn * petals)) % 4;
      const vec3 value = lead ? vec3(0.01f) : glass[colour] * (0.75f + 0.25f * std::cos(6 * across));
      std::copy_n(&value.x, 3, picture.pixel(x, y));
    }
  return picture;
}

// Figure 3.5.
void makeSlide(const fs::path& folder) {
  image::writeImage(folder / "rose.png", roseWindow(), {});
  Gltf gltf = newScene();
  addFloor(gltf);
  addWall(gltf, 2.2f, {0.8f, 0.8f, 0.8f});
  Shape pane;
  pane.addPlane({-0.5f, 0, 0}, {1, 0, 0}, {0, 1, 0});
  pane.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  gltf.addShape(
      "slide", pane,
      gltf.addMaterial({.name = "slide", .roughness = 0.2f, .transmission = 1, .picture = "rose.png"}),
      at({0, 0.75f, 0.4f}));
  Shape posts;
  posts.addBox({-0.56f, 0, 0.37f}, {-0.5f, 1.81f, 0.43f});
  posts.addBox({0.5f, 0, 0.37f}, {0.56f, 1.81f, 0.43f});
  posts.addBox({-0.5f, 1.75f, 0.37f}, {0.5f, 1.81f, 0.43f});
  posts.addBox({-0.5f, 0.69f, 0.37f}, {0.5f, 0.75f, 0.43f});
  gltf.addShape("frame", posts, gltf.addMaterial({.name = "wood", .colour = {0.2f, 0.12f, 0.07f}}));
  addSpot(gltf, 130, {0.1f, 1.5f, 2.6f}, {0, 1.15f, 0}, 0.36f, 0.42f);
  addSky(gltf, 0.12f);
  gltf.addCamera("camera", 0.62f, lookingAt({2.6f, 1.9f, 3.9f}, {-0.15f, 1.15f, -0.8f}));
  gltf.write(folder / "slide.gltf");
}

// Figure 3.6.
void makeColouredSmoke(const fs::path& folder) {
  Gltf gltf = newScene();
  addFloor(gltf);
  addWall(gltf, 1.8f);
  const auto pane = [&](const vec3& colour, const vec3& corner) {
    Shape shape;
    shape.addPlane(corner, {0.9f, 0, 1.07f}, {0, 0.7f, 0});
    gltf.addShape(
        "pane", shape,
        gltf.addMaterial({.name = "glass", .colour = colour, .roughness = 0.1f, .transmission = 1}));
  };
  pane({0.95f, 0.08f, 0.1f}, {-2.48f, 1.2f, 1.16f});
  pane({0.1f, 0.3f, 0.95f}, {-2.48f, 1.92f, 1.16f});
  json smoke = at({0, 0, 0});
  smoke["scale"] = {1.25, 1.25, 1.25};
  addSmoke(gltf, "plume.vdb", 6, smoke, {0.94f, 0.94f, 0.94f}, 0.1f);
  gltf.addShape("ball", ball({0.95f, 0.45f, -0.9f}, 0.45f),
                gltf.addMaterial({.name = "plaster", .colour = {0.75f, 0.73f, 0.7f}}));
  addSpot(gltf, 420, {-3.7f, 2.4f, 3.1f}, {0, 1.35f, 0}, 0.22f, 0.3f);
  addSky(gltf, 0.1f);
  gltf.addCamera("camera", 0.62f, lookingAt({0.9f, 1.7f, 5}, {0.35f, 1.3f, 0}));
  gltf.write(folder / "coloured_smoke.gltf");
}

// Figure 3.7.
void makeCrossedSmoke(const fs::path& folder) {
  Gltf gltf = newScene();
  addFloor(gltf);
  addWall(gltf, 1.8f);
  const size_t stone = gltf.addMaterial({.name = "stone", .colour = {0.68f, 0.62f, 0.52f}});
  gltf.addShape("column", column({0.45f, 0, 0.05f}, 3, 0.11f), stone);
  gltf.addShape("column", column({-0.5f, 0, -0.25f}, 3, 0.11f), stone);
  Shape beam;
  beam.addBox({-1.6f, 1.5f, -0.06f}, {1.6f, 1.62f, 0.06f});
  gltf.addShape("beam", beam, gltf.addMaterial({.name = "wood", .colour = {0.35f, 0.2f, 0.1f}}));
  gltf.addShape("glass ball", ball({-0.15f, 0.95f, 0.25f}, 0.3f),
                gltf.addMaterial({.name = "glass",
                                  .colour = {0.3f, 0.75f, 0.9f},
                                  .roughness = 0.08f,
                                  .transmission = 1,
                                  .extras = {{"shadow_rim", 1}}}));
  json smoke = at({0, 0, 0});
  smoke["scale"] = {2, 1.25, 2};
  addSmoke(gltf, "plume.vdb", 7, smoke, {0.92f, 0.92f, 0.92f}, 0.2f);
  addSpot(gltf, 150, {-2.6f, 3, 3.4f}, {0, 1.2f, 0}, 0.36f, 0.48f);
  addSky(gltf, 0.2f);
  gltf.addCamera("camera", 0.6f, lookingAt({0.9f, 1.7f, 5}, {0, 1.35f, 0}));
  gltf.write(folder / "crossed_smoke.gltf");
}

// Figure 3.8: a low sun over flat and curved things.
void makeGrazing(const fs::path& folder) {
  Gltf gltf = newScene();
  addFloor(gltf);
  addWall(gltf, 6);
  const size_t stone = gltf.addMaterial({.name = "stone", .colour = {0.72f, 0.68f, 0.62f}});
  for (int i = 0; i < 4; ++i)
    gltf.addShape("column", column({1.6f * static_cast<float>(i) - 2.4f, 0, -1}, 1.9f, 0.16f), stone);
  gltf.addShape("ball", ball({-0.8f, 0.45f, 0.6f}, 0.45f), stone);
  gltf.addShape("ball", ball({0.9f, 0.3f, 0.9f}, 0.3f), stone);
  addSun(gltf, 8, {3, 0.55f, 0.9f});
  gltf.addCamera("camera", 0.62f, lookingAt({0, 1.7f, 5}, {0, 0.55f, 0}));
  gltf.write(folder / "grazing.gltf");
}

// Figure 3.9.
void makeLampInSmoke(const fs::path& folder) {
  Gltf gltf = newScene();
  addFloor(gltf);
  addWall(gltf, 1.8f);
  json smoke = at({0, 0, 0});
  smoke["scale"] = {1.8, 1.25, 1.8};
  addSmoke(gltf, "plume.vdb", 5, smoke, {0.95f, 0.93f, 0.9f}, 0);
  Shape post;
  post.addTube({0, 0, 0}, 1, 0.025f, 0.015f);
  gltf.addShape("post", post, gltf.addMaterial({.name = "iron", .colour = {0.1f, 0.1f, 0.1f}}));
  addLamp(gltf, {0, 1.06f, 0}, {1, 0.72f, 0.42f}, 12);
  addSky(gltf, 0.08f);
  gltf.addCamera("camera", 0.6f, lookingAt({0.3f, 1.6f, 5}, {0, 1.3f, 0}));
  gltf.write(folder / "lamp_in_smoke.gltf");
}

// A fire before a wall: its gas is seen to glow, and eight lights in it light the floor, the stones and its
// smoke.
void makeFire(const fs::path& folder) {
  const volumes::FlameGrids flame = volumes::makeFlame(160, 2.4, 3);
  const volumes::DensityGrid* grids[] = {&flame.smoke, &flame.temperature};
  volumes::writeVdb(folder / "fire.vdb", grids);
  Gltf gltf = newScene();
  addFloor(gltf);
  addWall(gltf, 1.6f);
  const size_t stone = gltf.addMaterial({.name = "stone", .colour = {0.45f, 0.43f, 0.4f}});
  for (int i = 0; i < 9; ++i) {
    const float angle = 2 * pi * static_cast<float>(i) / 9;
    gltf.addShape("stone", ball({0.62f * std::cos(angle), 0.09f, 0.62f * std::sin(angle)}, 0.13f), stone);
  }
  addSmoke(gltf, "fire.vdb", 5, at({0, 0.02f, 0}), {0.75f, 0.75f, 0.75f}, 0.3f,
           {{"volume_fire", "temperature"}, {"volume_fire_strength", 0.35}, {"volume_fire_lights", 8}});
  addSky(gltf, 0.06f);
  gltf.addCamera("camera", 0.6f, lookingAt({0.3f, 1.1f, 4.6f}, {0, 1, 0}));
  gltf.write(folder / "fire.gltf");
}

// A thick plume before the sun; rendered with --multiscatter.
void makeMultiscatter(const fs::path& folder) {
  Gltf gltf = newScene();
  addFloor(gltf);
  addWall(gltf, 2.2f, {0.3f, 0.34f, 0.4f});
  json smoke = at({0, 0, 0});
  smoke["scale"] = {1.5, 1.1, 1.5};
  addSmoke(gltf, "plume.vdb", 30, smoke, {0.98f, 0.98f, 0.98f}, 0.4f);
  addSun(gltf, 4.5f, {-2.4f, 1.9f, 0.35f});
  addSky(gltf, 0.12f);
  gltf.addCamera("camera", 0.6f, lookingAt({0.2f, 1.4f, 5}, {0, 1.25f, 0}));
  gltf.write(folder / "multiscatter.gltf");
}

// The camera stands in the plume: steps begin at the eye, not at a face of the volume's box.
void makeCameraInSmoke(const fs::path& folder) {
  Gltf gltf = newScene();
  addFloor(gltf);
  addWall(gltf, 5);
  const size_t stone = gltf.addMaterial({.name = "stone", .colour = {0.72f, 0.68f, 0.62f}});
  for (int i = 0; i < 4; ++i)
    gltf.addShape("column", column({1.7f * static_cast<float>(i) - 2.55f, 0, -2}, 3, 0.2f), stone);
  json smoke = at({0, -0.6f, 0.6f});
  smoke["scale"] = {4, 1.6, 4};
  addSmoke(gltf, "plume.vdb", 1.1f, smoke, {0.95f, 0.94f, 0.92f}, 0.3f);
  addSpot(gltf, 200, {-3.4f, 4, 0.2f}, {0.3f, 0.8f, -1.2f}, 0.3f, 0.42f);
  addLamp(gltf, {1.1f, 1.2f, -0.6f}, {1, 0.62f, 0.3f}, 4);
  addSky(gltf, 0.25f);
  gltf.addCamera("camera", 0.9f, lookingAt({0, 1.35f, 1.1f}, {0, 1.35f, -2}));
  gltf.write(folder / "camera_in_smoke.gltf");
}

// Figure 3.14, seen from outside the lights and from among them.
void makeManyLights(const fs::path& folder, const char* name, const vec3& eye, const vec3& target) {
  Gltf gltf = newScene();
  addFloor(gltf);
  addWall(gltf, 3);
  const size_t paint = gltf.addMaterial({.name = "paint", .colour = {0.7f, 0.7f, 0.7f}});
  base::Random random(7);
  const auto between = [&](double low, double high) { return static_cast<float>(random.uniform(low, high)); };
  for (int row = 0; row < 3; ++row)
    for (int i = 0; i < 5; ++i) {
      const float radius = between(0.15, 0.3);
      gltf.addShape(
          "ball",
          ball({1.1f * static_cast<float>(i - 2), radius, 1.1f * static_cast<float>(row - 1)}, radius),
          paint);
    }
  for (int i = 0; i < 40; ++i) {
    const vec3 position{between(-3, 3), between(0.25, 0.9), between(-2, 2)};
    const float hue = between(0, 1);
    const vec3 colour = 0.5f + 0.5f * glm::cos(2 * pi * (hue + vec3(0, 1 / 3.f, 2 / 3.f)));
    gltf.addLight("lamp", {{"type", "point"}, {"color", toJson(colour)}, {"intensity", 0.55}, {"range", 1.8}},
                  at(position));
  }
  gltf.addCamera("camera", 0.6f, lookingAt(eye, target));
  gltf.write(folder / name);
}

// Section 2.2.4: beside each object the same one with a flag.
void makeFlags(const fs::path& folder) {
  Gltf gltf = newScene();
  addFloor(gltf);
  Shape bracket;
  bracket.addBox({-0.1f, 0, -0.35f}, {0, 0.75f, 0.35f});
  bracket.addBox({0, 0, -0.35f}, {0.55f, 0.2f, 0.35f});
  const vec3 clay(0.7f, 0.38f, 0.22f);
  gltf.addShape("bracket", bracket, gltf.addMaterial({.name = "clay", .colour = clay}), at({-1.75f, 0, 0}));
  gltf.addShape(
      "bracket without its own shadow", bracket,
      gltf.addMaterial(
          {.name = "clay that does not shadow itself", .colour = clay, .extras = {{"shadow_self", false}}}),
      at({-0.65f, 0, 0}));
  Shape jar;
  for (const float radius : {0.12f, 0.2f, 0.28f}) jar.addTube({0, 0.15f, 0}, 0.75f, radius, radius, 96);
  const vec3 green(0.45f, 0.75f, 0.4f);
  gltf.addShape("jar", jar,
                gltf.addMaterial({.name = "glass", .colour = green, .roughness = 0.1f, .transmission = 1}),
                at({0.55f, 0, -0.1f}));
  gltf.addShape("jar that shadows once", jar,
                gltf.addMaterial({.name = "glass that shadows once",
                                  .colour = green,
                                  .roughness = 0.1f,
                                  .transmission = 1,
                                  .extras = {{"shadow_once", true}}}),
                at({1.6f, 0, -0.1f}));
  addSun(gltf, 3.2f, {-1.1f, 1.5f, 0.25f});
  addSky(gltf, 0.25f);
  gltf.addCamera("camera", 0.46f, lookingAt({0.15f, 2.6f, 5}, {0.15f, 0.3f, 0.05f}));
  gltf.write(folder / "flags.gltf");
}

// Light from all around, and a weak sun; rendered with and without --ssao.
void makeCourtyard(const fs::path& folder) {
  Gltf gltf = newScene();
  addFloor(gltf);
  addWall(gltf, 1.6f);
  const size_t stone = gltf.addMaterial({.name = "stone", .colour = {0.62f, 0.57f, 0.5f}});
  const size_t clay = gltf.addMaterial({.name = "clay", .colour = {0.7f, 0.38f, 0.22f}});
  for (int i = 0; i < 4; ++i)
    gltf.addShape("column", column({1.3f * static_cast<float>(i) - 2.2f, 0, -1.2f}, 2.4f, 0.15f), stone);
  Shape steps;
  for (int i = 0; i < 5; ++i) {
    const auto up = static_cast<float>(i);
    steps.addBox({1.2f + 0.22f * up, 0, -0.9f}, {2.6f, 0.16f * (up + 1), 0.5f});
  }
  gltf.addShape("steps", steps, stone);
  gltf.addShape("teapot", teapot(), clay, at({-0.9f, 0, 0.1f}));
  gltf.addShape("ball", ball({0.35f, 0.3f, -0.1f}, 0.3f), stone);
  gltf.addShape("ball", ball({0.75f, 0.18f, 0.35f}, 0.18f), clay);
  gltf.addShape("glass", ball({-0.1f, 0.22f, 0.75f}, 0.22f),
                gltf.addMaterial({.name = "glass", .colour = {0.6f, 0.85f, 0.8f}, .transmission = 1}));
  gltf.setAmbient({0.5f, 0.55f, 0.62f});
  addSun(gltf, 1.1f, {-2.4f, 3.2f, 2.2f});
  gltf.addCamera("camera", 0.6f, lookingAt({0.9f, 1.7f, 3.6f}, {0.3f, 0.55f, -0.5f}));
  gltf.write(folder / "courtyard.gltf");
}

void makeGallery(const fs::path& folder) {
  constexpr int voxelsHigh = 192;
  constexpr double plumeHeight = 2.3;
  constexpr uint64_t seed = 2;
  makeCourtyard(folder);
  volumes::writeVdb(folder / "plume.vdb", volumes::makePlume(voxelsHigh, plumeHeight, seed));
  makeCurtains(folder);
  makeCurtainsInSpot(folder);
  makeVolumes(folder);
  makeSmoke(folder);
  makeBlades(folder);
  makeTeapots(folder);
  makeSlide(folder);
  makeColouredSmoke(folder);
  makeCrossedSmoke(folder);
  makeGrazing(folder);
  makeLampInSmoke(folder);
  makeCameraInSmoke(folder);
  makeFire(folder);
  makeMultiscatter(folder);
  makeManyLights(folder, "many_lights.gltf", {0.4f, 2.2f, 4.6f}, {0, 0.1f, 0});
  makeManyLights(folder, "camera_in_many_lights.gltf", {0.5f, 0.75f, 1.7f}, {-0.2f, 0.3f, -1});
  makeFlags(folder);
}

}  // namespace
}  // namespace sfumato::demos

int main(int argc, char** argv) {
  return sfumato::demos::makeScenes("make_gallery_scenes", argc, argv, sfumato::demos::makeGallery);
}
