// Writes the demo scene into a folder: demo.gltf, demo.bin and plume.vdb. A small hall at night: a bowl
// smokes between columns, a spot light shines into the smoke through stained glass, a lamp through a curtain.
#include <cmath>

#include "demos/gltf_writer.h"
#include "volumes/procedural_smoke.h"
#include "volumes/vdb_file.h"

namespace sfumato::demos {
namespace {

using glm::vec3;
using nlohmann::json;

constexpr vec3 bowl(0.1f, 0, -0.4f);  // where the smoke rises
constexpr float bowlHeight = 0.34f;

void addHall(Gltf& gltf) {
  constexpr int tiles = 12;
  constexpr float side = 0.8f;
  Shape light, dark;
  for (int row = 0; row < tiles; ++row)
    for (int column = 0; column < tiles; ++column) {
      const vec3 corner(side * static_cast<float>(column - tiles / 2), 0, side * static_cast<float>(row - 3));
      ((row + column) % 2 == 0 ? light : dark).addPlane(corner, {0, 0, side}, {side, 0, 0});
    }
  gltf.addShape("light tiles", light, gltf.addMaterial({"light tile", {0.62f, 0.58f, 0.52f}, 0.5f}));
  gltf.addShape("dark tiles", dark, gltf.addMaterial({"dark tile", {0.22f, 0.2f, 0.19f}, 0.5f}));

  Shape wall;
  wall.addPlane({-4.8f, 0, -2.4f}, {9.6f, 0, 0}, {0, 4.6f, 0});
  gltf.addShape("back wall", wall, gltf.addMaterial({"plaster", {0.55f, 0.52f, 0.5f}}));
}

void addColumns(Gltf& gltf) {
  const size_t stone = gltf.addMaterial({"stone", {0.66f, 0.62f, 0.55f}, 0.8f});
  constexpr float height = 3.6f, radius = 0.17f, block = 0.25f;
  Shape column;
  column.addTube({0, block, 0}, height - 2 * block, radius, 0.86f * radius);
  column.addBox({-block, 0, -block}, {block, block, block});
  column.addBox({-block, height - block, -block}, {block, height, block});
  gltf.addShape("left column", column, stone, at({-3.1f, 0, -1.4f}));
  gltf.addShape("column in the smoke", column, stone, at(bowl + vec3(0.5f, 0, -0.2f)));
  gltf.addShape("right column", column, stone, at({3.3f, 0, -1.6f}));
}

// A window that stands on two posts: panes of coloured glass between dark bars, looking along its +Z.
void addWindow(Gltf& gltf, const json& placement) {
  constexpr int columns = 3, rows = 3;
  constexpr float pane = 0.34f, bar = 0.045f, sill = 1.42f;
  const auto glass = [](const char* name, const vec3& colour) {
    return Material{name, colour, 0.1f, 1, 1, {}, {}};
  };
  const Material panes[rows * columns] = {
      glass("ruby", {0.95f, 0.07f, 0.05f}),  glass("amber", {1.f, 0.6f, 0.08f}),
      glass("emerald", {0.08f, 0.7f, 0.2f}), glass("cobalt", {0.1f, 0.22f, 0.95f}),
      glass("rose", {1.f, 0.3f, 0.45f}),     glass("gold", {1.f, 0.75f, 0.15f}),
      glass("violet", {0.55f, 0.15f, 0.9f}), glass("turquoise", {0.1f, 0.8f, 0.8f}),
      glass("flame", {1.f, 0.32f, 0.06f})};
  const float width = columns * pane + (columns + 1) * bar;
  const auto barBegin = [&](int i) { return static_cast<float>(i) * (pane + bar); };

  Shape frame;
  const float top = sill + barBegin(rows) + bar;
  for (int i = 0; i <= columns; ++i) {
    const float x = barBegin(i) - width / 2;
    const bool isPost = i == 0 || i == columns;
    frame.addBox({x, isPost ? 0 : sill, -bar / 2}, {x + bar, top, bar / 2});
  }
  for (int i = 0; i <= rows; ++i) {
    const float y = sill + barBegin(i);
    frame.addBox({-width / 2, y, -bar / 2}, {width / 2, y + bar, bar / 2});
  }
  gltf.addShape("window frame", frame, gltf.addMaterial({"dark wood", {0.09f, 0.06f, 0.04f}, 0.7f}),
                placement);

  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const Material& material = panes[row * columns + column];
      Shape shape;
      shape.addPlane({barBegin(column) + bar - width / 2, sill + barBegin(row) + bar, 0}, {pane, 0, 0},
                     {0, pane, 0});
      gltf.addShape(material.name, shape, gltf.addMaterial(material), placement);
    }
}

// A cloth in folds that widen towards its hem, looking along its +Z.
void addCurtain(Gltf& gltf, const json& placement) {
  constexpr int across = 96, down = 48;
  constexpr float width = 1.5f, height = 2.7f, folds = 6;
  const auto point = [](float u, float v) {
    const float depth = 0.03f + 0.06f * v;
    const float fold =
        std::sin(2 * pi * folds * u + 0.8f * std::sin(2.5f * v)) + 0.35f * std::sin(7.f * u + 2.f * v);
    return vec3(width * (u - 0.5f), height * (1 - v), depth * fold);
  };
  Shape cloth;
  cloth.addSurface(across, down, point);
  gltf.addShape("curtain", cloth, gltf.addMaterial({"crimson cloth", {0.75f, 0.09f, 0.12f}, 0.9f, 0.6f}),
                placement);
}

void addSmoke(Gltf& gltf) {
  Shape vessel;
  vessel.addTube(bowl, 0.2f, 0.12f, 0.06f);
  vessel.addTube(bowl + vec3(0, 0.2f, 0), bowlHeight - 0.2f, 0.06f, 0.2f);
  vessel.addDisc(bowl + vec3(0, bowlHeight - 0.03f, 0), 0.18f);
  gltf.addShape("bowl", vessel, gltf.addMaterial({"bronze", {0.3f, 0.2f, 0.1f}, 0.5f}));

  constexpr float wider = 1.25f;
  json smoke = at(bowl + vec3(0, bowlHeight - 0.03f, 0));
  smoke["scale"] = {wider, wider, wider};
  smoke["extras"] = {{"volume", "plume.vdb"},
                     {"volume_grid", "density"},
                     {"volume_scale", 8},
                     {"volume_albedo", {0.92, 0.92, 0.94}},
                     {"volume_g", 0.25}};
  gltf.addNode("smoke", smoke);
}

void addLights(Gltf& gltf, const vec3& spot) {
  const json cone = {{"innerConeAngle", 0.19}, {"outerConeAngle", 0.26}};
  gltf.addLight("light behind the glass",
                {{"type", "spot"}, {"color", {1, 0.96, 0.9}}, {"intensity", 400}, {"spot", cone}},
                lookingAt(spot, bowl + vec3(0, 1.18f, 0)));
  gltf.addLight("lamp", {{"type", "point"}, {"color", {1, 0.62, 0.3}}, {"intensity", 3.5}},
                at({1.35f, 1.3f, 0.9f}));
  gltf.addLight("night sky", {{"type", "directional"}, {"color", {0.5, 0.68, 1}}, {"intensity", 1.1}},
                lookingAt({-0.8f, 3, 2.4f}, {0, 0, 0}));
}

void makeScene(const std::filesystem::path& folder) {
  constexpr int voxelsHigh = 224;
  constexpr double plumeHeight = 2.3;
  constexpr uint64_t seed = 2;
  volumes::writeVdb(folder / "plume.vdb", volumes::makePlume(voxelsHigh, plumeHeight, seed));

  Gltf gltf("make_demo_scene");
  addHall(gltf);
  addColumns(gltf);
  // The window stands between the spot light and the smoke, and looks at both.
  const vec3 spot(-3.3f, 3.2f, -2.f);
  const vec3 towards = bowl - spot;
  const vec3 window = spot + 0.58f * towards;
  addWindow(gltf, turned({window.x, 0, window.z}, std::atan2(towards.x, towards.z)));
  addCurtain(gltf, turned({1.95f, 0.15f, -0.6f}, -0.45f));
  addSmoke(gltf);
  addLights(gltf, spot);
  gltf.addCamera("camera", 0.66f, lookingAt({0.2f, 1.6f, 4.9f}, {0, 1.62f, -0.4f}));
  gltf.write(folder / "demo.gltf");
}

}  // namespace
}  // namespace sfumato::demos

int main(int argc, char** argv) {
  return sfumato::demos::makeScenes("make_demo_scene", argc, argv, sfumato::demos::makeScene);
}
