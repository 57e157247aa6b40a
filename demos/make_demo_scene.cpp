// Writes the demo scene into a folder: demo.gltf, demo.bin and plume.vdb. A small hall at night: a bowl
// smokes between columns, a spot light shines into the smoke through stained glass, a lamp through a curtain.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "volumes/procedural_smoke.h"
#include "volumes/vdb_file.h"

namespace sfumato::demos {
namespace {

using glm::vec3;
using nlohmann::json;

constexpr float pi = 3.14159265f;

json toJson(const vec3& v) {
  return {v.x, v.y, v.z};
}

// Triangles of one material.
struct Shape {
  std::vector<vec3> positions;
  std::vector<vec3> normals;
  std::vector<uint32_t> indices;

  uint32_t vertex(const vec3& position, const vec3& normal) {
    positions.push_back(position);
    normals.push_back(normal);
    return static_cast<uint32_t>(positions.size() - 1);
  }

  // The four corners counter-clockwise, seen from the front.
  void quad(uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
    indices.insert(indices.end(), {a, b, c, a, c, d});
  }

  // A parallelogram: `corner` and two edges.
  void addPlane(const vec3& corner, const vec3& right, const vec3& up) {
    const vec3 normal = glm::normalize(glm::cross(right, up));
    const uint32_t first = vertex(corner, normal);
    vertex(corner + right, normal);
    vertex(corner + right + up, normal);
    vertex(corner + up, normal);
    quad(first, first + 1, first + 2, first + 3);
  }

  void addBox(const vec3& low, const vec3& high) {
    const vec3 size = high - low;
    const vec3 x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
    addPlane(low + z, x, y);
    addPlane(low + x, -x, y);
    addPlane(low, z, y);
    addPlane(low + x + z, -z, y);
    addPlane(low + y + z, x, -z);
    addPlane(low, x, z);
  }

  // Upright, open at both ends; its radius goes from `lower` to `upper`.
  void addTube(const vec3& foot, float height, float lower, float upper, int sides = 48) {
    const auto first = static_cast<uint32_t>(positions.size());
    for (int i = 0; i <= sides; ++i) {
      const float angle = 2 * pi * static_cast<float>(i) / static_cast<float>(sides);
      const vec3 outwards(std::sin(angle), 0, std::cos(angle));
      const vec3 normal = glm::normalize(outwards + vec3(0, (lower - upper) / height, 0));
      vertex(foot + lower * outwards, normal);
      vertex(foot + upper * outwards + vec3(0, height, 0), normal);
    }
    for (uint32_t i = first; i < first + 2 * static_cast<uint32_t>(sides); i += 2)
      quad(i, i + 2, i + 3, i + 1);
  }

  // A level disc that looks up.
  void addDisc(const vec3& centre, float radius, int sides = 48) {
    const vec3 up(0, 1, 0);
    const uint32_t middle = vertex(centre, up);
    for (int i = 0; i <= sides; ++i) {
      const float angle = 2 * pi * static_cast<float>(i) / static_cast<float>(sides);
      vertex(centre + radius * vec3(std::sin(angle), 0, std::cos(angle)), up);
    }
    for (uint32_t i = middle + 1; i <= middle + static_cast<uint32_t>(sides); ++i)
      indices.insert(indices.end(), {middle, i, i + 1});
  }
};

struct Material {
  const char* name;
  vec3 colour;
  float roughness = 0.9f;
  float alpha = 1;
  bool glass = false;
};

// A glTF file in the making; indices are as in the format.
class Gltf {
 public:
  Gltf() {
    root_["asset"] = {{"version", "2.0"}, {"generator", "sfumato make_demo_scene"}};
    root_["extensionsUsed"] = {"KHR_lights_punctual", "KHR_materials_transmission"};
    root_["scene"] = 0;
  }

  size_t addMaterial(const Material& material) {
    json entry = {
        {"name", material.name},
        {"doubleSided", true},
        {"pbrMetallicRoughness",
         {{"baseColorFactor", {material.colour.x, material.colour.y, material.colour.z, material.alpha}},
          {"metallicFactor", 0},
          {"roughnessFactor", material.roughness}}}};
    if (material.alpha < 1) entry["alphaMode"] = "BLEND";
    if (material.glass) entry["extensions"]["KHR_materials_transmission"] = {{"transmissionFactor", 1}};
    return add("materials", entry);
  }

  void addShape(const char* name, const Shape& shape, size_t material, json placement = json::object()) {
    const json primitive = {
        {"attributes", {{"POSITION", addPositions(shape.positions)}, {"NORMAL", addVectors(shape.normals)}}},
        {"indices", addIndices(shape.indices)},
        {"material", material}};
    placement["mesh"] = add("meshes", {{"name", name}, {"primitives", {primitive}}});
    addNode(name, placement);
  }

  void addLight(const char* name, json light, const json& placement) {
    light["name"] = name;
    json& lights = root_["extensions"]["KHR_lights_punctual"]["lights"];
    lights.push_back(light);
    json node = placement;
    node["extensions"]["KHR_lights_punctual"]["light"] = lights.size() - 1;
    addNode(name, node);
  }

  void addCamera(const char* name, float yfov, json placement) {
    placement["camera"] =
        add("cameras",
            {{"name", name}, {"type", "perspective"}, {"perspective", {{"yfov", yfov}, {"znear", 0.05}}}});
    addNode(name, placement);
  }

  void addNode(const char* name, json node) {
    node["name"] = name;
    root_["scenes"][0]["nodes"].push_back(add("nodes", node));
  }

  // Writes `path` and its buffer, PATH with the ending .bin.
  void write(const std::filesystem::path& path) {
    std::filesystem::path bin = path;
    bin.replace_extension(".bin");
    root_["buffers"] = {{{"uri", bin.filename().string()}, {"byteLength", buffer_.size()}}};
    base::writeFile(bin, buffer_);
    base::writeFile(path, root_.dump(1) + "\n");
  }

 private:
  size_t add(const char* list, const json& entry) {
    root_[list].push_back(entry);
    return root_[list].size() - 1;
  }

  template <typename T>
  size_t addAccessor(const std::vector<T>& values, json accessor) {
    const size_t bytes = values.size() * sizeof(T);
    accessor["bufferView"] =
        add("bufferViews", {{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", bytes}});
    accessor["count"] = values.size();
    buffer_.append(reinterpret_cast<const char*>(values.data()), bytes);
    return add("accessors", accessor);
  }

  size_t addIndices(const std::vector<uint32_t>& indices) {
    constexpr int unsignedInt = 5125;
    return addAccessor(indices, {{"componentType", unsignedInt}, {"type", "SCALAR"}});
  }

  size_t addVectors(const std::vector<vec3>& vectors, json accessor = json::object()) {
    constexpr int floatType = 5126;
    accessor["componentType"] = floatType;
    accessor["type"] = "VEC3";
    return addAccessor(vectors, accessor);
  }

  size_t addPositions(const std::vector<vec3>& positions) {
    vec3 low = positions.front(), high = low;
    for (const vec3& p : positions) {
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
    return addVectors(positions, {{"min", toJson(low)}, {"max", toJson(high)}});
  }

  json root_;
  std::string buffer_;
};

json at(const vec3& position) {
  return {{"translation", toJson(position)}};
}

// Turned about the vertical by `angle` radians.
json turned(const vec3& position, float angle) {
  return {{"translation", toJson(position)}, {"rotation", {0, std::sin(angle / 2), 0, std::cos(angle / 2)}}};
}

// For a camera or a light: at `eye`, its -Z towards `target`.
json lookingAt(const vec3& eye, const vec3& target) {
  const vec3 z = glm::normalize(eye - target);
  const vec3 x = glm::normalize(glm::cross(vec3(0, 1, 0), z));
  const vec3 y = glm::cross(z, x);
  return {{"matrix", {x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, eye.x, eye.y, eye.z, 1}}};
}

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
    return Material{name, colour, 0.1f, 1, true};
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
  for (int row = 0; row <= down; ++row)
    for (int column = 0; column <= across; ++column) {
      const float u = static_cast<float>(column) / across, v = static_cast<float>(row) / down, step = 1e-3f;
      const vec3 alongU = point(u + step, v) - point(u - step, v);
      const vec3 alongV = point(u, v + step) - point(u, v - step);
      cloth.vertex(point(u, v), glm::normalize(glm::cross(alongV, alongU)));
    }
  for (uint32_t row = 0; row < down; ++row)
    for (uint32_t column = 0; column < across; ++column) {
      const uint32_t upper = row * (across + 1) + column, lower = upper + across + 1;
      cloth.quad(lower, lower + 1, upper + 1, upper);
    }
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

  Gltf gltf;
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
  using sfumato::base::ExitCode;
  if (argc != 2) {
    std::fputs("usage: make_demo_scene FOLDER\n", stderr);
    return static_cast<int>(ExitCode::Usage);
  }
  try {
    std::filesystem::create_directories(argv[1]);
    sfumato::demos::makeScene(argv[1]);
  } catch (const sfumato::base::Error& error) {
    std::fprintf(stderr, "make_demo_scene: error: %s\n", error.what());
    return static_cast<int>(error.exitCode);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "make_demo_scene: error: %s: cannot be written: %s\n", argv[1], error.what());
    return static_cast<int>(ExitCode::Input);
  }
}
