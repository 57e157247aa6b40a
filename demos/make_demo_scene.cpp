// Writes the demo scene into a folder: demo.gltf, demo.bin, plume.vdb and haze.vdb. A hall at noon: a bowl
// smokes between columns, the sun falls through stained glass into the haze, lamps burn behind curtains, and
// a glass globe stands on a pedestal.
#include <cmath>

#include "demos/gltf_writer.h"
#include "volumes/procedural_smoke.h"
#include "volumes/vdb_file.h"

namespace sfumato::demos {
namespace {

using glm::vec3;
using nlohmann::json;

// The hall's inside: x to the right, z towards the camera.
constexpr vec3 hallLow(-3.2f, 0, -6), hallHigh(3.4f, 5.5f, 9);
constexpr vec3 bowl(-0.1f, 0, -1.3f);  // where the smoke rises
constexpr float bowlHeight = 0.34f;
constexpr vec3 towardsSun(-1, 0.6f, 0.16f);

// Windows in the left wall: a grid of panes between dark bars.
constexpr float windowCentres[] = {2.6f, -0.8f, -4.2f};  // z
constexpr int paneColumns = 4, paneRows = 7;
constexpr float paneWidth = 0.34f, paneHeight = 0.4f, bar = 0.035f;
constexpr float windowWidth = paneColumns * paneWidth + (paneColumns + 1) * bar;
constexpr float windowHeight = paneRows * paneHeight + (paneRows + 1) * bar;
constexpr float sill = 1.6f;

void addFloor(Gltf& gltf) {
  constexpr float side = 0.6f;
  Shape light, dark;
  for (int row = 0; hallLow.z + side * static_cast<float>(row) < hallHigh.z; ++row)
    for (int column = 0; hallLow.x + side * static_cast<float>(column) < hallHigh.x; ++column) {
      const vec3 corner = hallLow + side * vec3(column, 0, row);
      ((row + column) % 2 == 0 ? light : dark).addPlane(corner, {0, 0, side}, {side, 0, 0});
    }
  gltf.addShape("light tiles", light, gltf.addMaterial({"light tile", {0.6f, 0.56f, 0.5f}, 0.45f}));
  gltf.addShape("dark tiles", dark, gltf.addMaterial({"dark tile", {0.2f, 0.18f, 0.17f}, 0.45f}));
}

void addWalls(Gltf& gltf) {
  constexpr float thick = 0.35f;
  Shape walls;
  walls.addBox({hallLow.x, 0, hallLow.z - thick}, {hallHigh.x, hallHigh.y, hallLow.z});
  walls.addBox({hallHigh.x, 0, hallLow.z}, {hallHigh.x + thick, hallHigh.y, hallHigh.z});
  // The left wall: under, over and between its windows.
  const float left = hallLow.x - thick, right = hallLow.x;
  walls.addBox({left, 0, hallLow.z - thick}, {right, sill, hallHigh.z});
  walls.addBox({left, sill + windowHeight, hallLow.z - thick}, {right, 2 * hallHigh.y, hallHigh.z});
  float pierEnd = hallHigh.z;
  for (const float centre : windowCentres) {
    walls.addBox({left, sill, centre + windowWidth / 2}, {right, sill + windowHeight, pierEnd});
    pierEnd = centre - windowWidth / 2;
  }
  walls.addBox({left, sill, hallLow.z - thick}, {right, sill + windowHeight, pierEnd});
  gltf.addShape("walls", walls, gltf.addMaterial({"plaster", {0.6f, 0.56f, 0.5f}}));

  constexpr float roofEnd = 2.6f;
  Shape roof;
  roof.addBox({left, hallHigh.y, hallLow.z - thick}, {hallHigh.x + thick, hallHigh.y + 0.2f, roofEnd});
  for (float z = hallLow.z + 0.9f; z < roofEnd; z += 1.75f)
    roof.addBox({hallLow.x, hallHigh.y - 0.28f, z - 0.12f}, {hallHigh.x, hallHigh.y, z + 0.12f});
  gltf.addShape("roof", roof, gltf.addMaterial({"dark wood", {0.2f, 0.13f, 0.08f}, 0.7f}));

  // What is seen through the windows; the sun looks over it.
  Shape sky;
  sky.addPlane({-12, -4, 20}, {0, 0, -40}, {0, 10, 0});
  gltf.addShape("sky", sky,
                gltf.addMaterial({.name = "sky", .colour = vec3(0), .emission = {0.9f, 1.1f, 1.4f}}));
}

void addColumns(Gltf& gltf) {
  constexpr float radius = 0.2f, block = 0.3f;
  const float height = hallHigh.y - 0.28f;
  Shape column;
  column.addTube({0, block, 0}, height - 2 * block, radius, 0.86f * radius, 64);
  column.addBox({-block, 0, -block}, {block, block, block});
  column.addBox({-block, height - block, -block}, {block, height, block});
  const size_t stone = gltf.addMaterial({"stone", {0.68f, 0.63f, 0.55f}, 0.8f});
  for (const float z : {1.75f, -1.4f, -4.3f}) gltf.addShape("right column", column, stone, at({2.05f, 0, z}));
  for (const float z : {-1.8f, -4.3f}) gltf.addShape("left column", column, stone, at({-2.2f, 0, z}));
  gltf.addShape("column in the smoke", column, stone, at(bowl + vec3(0.62f, 0, -0.25f)));
}

// Panes of one colour are one object.
void addWindows(Gltf& gltf) {
  struct Glass {
    const char* name;
    vec3 colour;
  };
  constexpr Glass glasses[] = {{"ruby", {0.95f, 0.06f, 0.05f}},  {"amber", {1.f, 0.55f, 0.07f}},
                               {"cobalt", {0.07f, 0.2f, 0.95f}}, {"emerald", {0.06f, 0.75f, 0.2f}},
                               {"violet", {0.5f, 0.12f, 0.9f}},  {"turquoise", {0.08f, 0.75f, 0.85f}},
                               {"straw", {1.f, 0.85f, 0.45f}}};
  // One window: a border of straw and amber about a lozenge of the others.
  constexpr int pattern[paneRows][paneColumns] = {{6, 1, 1, 6}, {1, 0, 0, 1}, {4, 5, 5, 4}, {2, 0, 0, 2},
                                                  {4, 5, 5, 4}, {1, 3, 3, 1}, {6, 1, 1, 6}};
  const float x = hallLow.x - 0.15f;
  Shape bars;
  Shape panes[std::size(glasses)];
  for (const float centre : windowCentres) {
    const auto z = [&](int column) {
      return centre - windowWidth / 2 + static_cast<float>(column) * (paneWidth + bar);
    };
    const auto y = [&](int row) { return sill + static_cast<float>(row) * (paneHeight + bar); };
    for (int i = 0; i <= paneColumns; ++i)
      bars.addBox({x - bar, sill, z(i)}, {x + bar, sill + windowHeight, z(i) + bar});
    for (int i = 0; i <= paneRows; ++i)
      bars.addBox({x - bar / 2, y(i), z(0)}, {x + bar / 2, y(i) + bar, z(paneColumns) + bar});
    for (int row = 0; row < paneRows; ++row)
      for (int column = 0; column < paneColumns; ++column)
        panes[pattern[row][column]].addPlane({x, y(row) + bar, z(column) + bar + paneWidth},
                                             {0, 0, -paneWidth}, {0, paneHeight, 0});
  }
  gltf.addShape("window bars", bars, gltf.addMaterial({"lead", {0.08f, 0.08f, 0.09f}, 0.6f}));
  for (size_t i = 0; i < std::size(glasses); ++i)
    gltf.addShape(
        glasses[i].name, panes[i],
        gltf.addMaterial(
            {.name = glasses[i].name, .colour = glasses[i].colour, .roughness = 0.1f, .transmission = 1}));
}

// A cloth in folds that widen towards its hem, looking along its +Z.
void addCurtain(Gltf& gltf, const Material& cloth, const json& placement) {
  constexpr float width = 2.7f, height = 3.1f, folds = 11;
  const auto point = [](float u, float v) {
    const float depth = 0.03f + 0.05f * v;
    const float fold =
        std::sin(2 * pi * folds * u + 0.8f * std::sin(2.5f * v)) + 0.35f * std::sin(7.f * u + 2.f * v);
    return vec3(width * (u - 0.5f), height * (1 - v), depth * fold);
  };
  Shape shape;
  shape.addSurface(128, 48, point);
  gltf.addShape(cloth.name, shape, gltf.addMaterial(cloth), placement);
}

void addCurtains(Gltf& gltf) {
  const Material crimson{"crimson cloth", {0.85f, 0.07f, 0.09f}, 0.9f, 0.5f};
  const Material gold{"golden cloth", {0.95f, 0.6f, 0.15f}, 0.9f, 0.5f};
  const Material green{"green cloth", {0.1f, 0.55f, 0.3f}, 0.9f, 0.5f};
  addCurtain(gltf, crimson, turned({-1.35f, 0.12f, -4.9f}, 0.08f));
  addCurtain(gltf, gold, turned({1.1f, 0.12f, -4.9f}, -0.08f));
  addCurtain(gltf, green, turned({2.2f, 0.12f, 0.2f}, -pi / 2));
  Shape rods;
  rods.addBox({hallLow.x, 3.28f, -4.93f}, {hallHigh.x, 3.33f, -4.88f});
  rods.addBox({2.18f, 3.28f, -1.4f}, {2.23f, 3.33f, 1.75f});
  gltf.addShape("rods", rods, gltf.addMaterial({"brass", {0.5f, 0.36f, 0.14f}, 0.4f}));
}

void addGlobe(Gltf& gltf) {
  const vec3 foot(1.05f, 0, 2.5f);
  Shape pedestal;
  pedestal.addBox(foot + vec3(-0.24f, 0, -0.24f), foot + vec3(0.24f, 0.1f, 0.24f));
  pedestal.addTube(foot + vec3(0, 0.1f, 0), 0.72f, 0.15f, 0.12f);
  pedestal.addBox(foot + vec3(-0.2f, 0.82f, -0.2f), foot + vec3(0.2f, 0.88f, 0.2f));
  gltf.addShape("pedestal", pedestal, gltf.addMaterial({"marble", {0.75f, 0.73f, 0.7f}, 0.4f}));
  Shape globe;
  globe.addBall(foot + vec3(0, 1.2f, 0), 0.32f);
  gltf.addShape("globe", globe,
                gltf.addMaterial({.name = "sea glass",
                                  .colour = {0.7f, 0.96f, 0.93f},
                                  .roughness = 0.07f,
                                  .transmission = 1,
                                  .extras = {{"shadow_rim", 1}}}));
}

void addSmoke(Gltf& gltf) {
  Shape vessel;
  vessel.addTube(bowl, 0.2f, 0.12f, 0.06f);
  vessel.addTube(bowl + vec3(0, 0.2f, 0), bowlHeight - 0.2f, 0.06f, 0.2f);
  vessel.addDisc(bowl + vec3(0, bowlHeight - 0.03f, 0), 0.18f);
  gltf.addShape("bowl", vessel, gltf.addMaterial({"bronze", {0.3f, 0.2f, 0.1f}, 0.5f}));

  constexpr float wider = 2;
  json smoke = at(bowl + vec3(0, bowlHeight - 0.03f, 0));
  smoke["scale"] = {wider, wider, wider};
  smoke["extras"] = {
      {"volume", "plume.vdb"}, {"volume_scale", 8}, {"volume_albedo", {0.93, 0.93, 0.95}}, {"volume_g", 0.3}};
  gltf.addNode("smoke", smoke);
  gltf.addNode("haze", {{"extras",
                         {{"volume", "haze.vdb"},
                          {"volume_scale", 0.05},
                          {"volume_albedo", {0.95, 0.95, 0.95}},
                          {"volume_g", 0.45}}}});
}

// Thin haze that fills the hall, slowly thicker and thinner from place to place.
volumes::DensityGrid makeHaze() {
  constexpr double voxel = 0.06;  // short beside a pane, as it sets the steps of the march
  volumes::DensityGrid grid{.name = "density", .size = glm::ivec3((hallHigh - hallLow) / float(voxel)) + 1};
  const glm::dmat4 scaled = glm::dmat4(glm::dmat3(voxel));
  grid.worldFromIndex = scaled;
  grid.worldFromIndex[3] = glm::dvec4(glm::dvec3(hallLow), 1);
  grid.values.resize(static_cast<size_t>(grid.size.x) * grid.size.y * grid.size.z);
  for (int z = 1; z + 1 < grid.size.z; ++z)
    for (int y = 1; y + 1 < grid.size.y; ++y)
      for (int x = 1; x + 1 < grid.size.x; ++x) {
        const glm::dvec3 p = voxel * glm::dvec3(x, y, z);
        const double waves = std::sin(1.3 * p.x + 1.9 * p.y + 0.7 * std::sin(1.1 * p.z)) *
                             std::sin(0.9 * p.z - 1.7 * p.y + 0.8 * std::sin(1.2 * p.x));
        grid.values[grid.valueIndex(x, y, z)] = static_cast<float>(0.75 + 0.25 * waves);
      }
  return grid;
}

void addLights(Gltf& gltf) {
  gltf.addLight("sun", {{"type", "directional"}, {"color", {1, 0.95, 0.86}}, {"intensity", 45}},
                lookingAt(towardsSun, {0, 0, 0}));
  gltf.addLight("open front", {{"type", "directional"}, {"color", {0.55, 0.7, 1}}, {"intensity", 3}},
                lookingAt({0.25f, 0.75f, 1}, {0, 0, 0}));
  const auto addLamp = [&](const char* name, float intensity, const vec3& position) {
    gltf.addLight(name, {{"type", "point"}, {"color", {1, 0.72, 0.42}}, {"intensity", intensity}},
                  at(position));
    Shape flame;
    flame.addBall(position + vec3(0, 0.12f, 0), 0.04f);
    gltf.addShape(name, flame, gltf.addMaterial({.name = name, .colour = vec3(0), .emission = {30, 20, 10}}));
  };
  addLamp("lamp under the roof", 11, {0.55f, 4.3f, -2.6f});
  addLamp("lamp behind the curtains", 4, {0.9f, 1.5f, -5.5f});
}

void makeScene(const std::filesystem::path& folder) {
  constexpr int voxelsHigh = 224;
  constexpr double plumeHeight = 2.3;
  constexpr uint64_t seed = 2;
  volumes::writeVdb(folder / "plume.vdb", volumes::makePlume(voxelsHigh, plumeHeight, seed));
  volumes::writeVdb(folder / "haze.vdb", makeHaze());

  Gltf gltf("make_demo_scene");
  addFloor(gltf);
  addWalls(gltf);
  addColumns(gltf);
  addWindows(gltf);
  addCurtains(gltf);
  addGlobe(gltf);
  addSmoke(gltf);
  addLights(gltf);
  gltf.addCamera("camera", 0.72f, lookingAt({0.55f, 1.6f, 7.3f}, {-0.25f, 2.1f, -1.3f}));
  gltf.write(folder / "demo.gltf");
}

}  // namespace
}  // namespace sfumato::demos

int main(int argc, char** argv) {
  return sfumato::demos::makeScenes("make_demo_scene", argc, argv, sfumato::demos::makeScene);
}
