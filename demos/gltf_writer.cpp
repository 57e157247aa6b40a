#include "demos/gltf_writer.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "base/error.h"
#include "base/file.h"

namespace sfumato::demos {

using glm::vec2;
using glm::vec3;
using nlohmann::json;

uint32_t Shape::vertex(const vec3& position, const vec3& normal) {
  positions.push_back(position);
  normals.push_back(normal);
  return static_cast<uint32_t>(positions.size() - 1);
}

void Shape::quad(uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
  indices.insert(indices.end(), {a, b, c, a, c, d});
}

void Shape::addPlane(const vec3& corner, const vec3& right, const vec3& up) {
  const vec3 normal = glm::normalize(glm::cross(right, up));
  const uint32_t first = vertex(corner, normal);
  vertex(corner + right, normal);
  vertex(corner + right + up, normal);
  vertex(corner + up, normal);
  quad(first, first + 1, first + 2, first + 3);
}

void Shape::addBox(const vec3& low, const vec3& high) {
  const vec3 size = high - low;
  const vec3 x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
  addPlane(low + z, x, y);
  addPlane(low + x, -x, y);
  addPlane(low, z, y);
  addPlane(low + x + z, -z, y);
  addPlane(low + y + z, x, -z);
  addPlane(low, x, z);
}

void Shape::addTube(const vec3& foot, float height, float lower, float upper, int sides) {
  const auto first = static_cast<uint32_t>(positions.size());
  for (int i = 0; i <= sides; ++i) {
    const float angle = 2 * pi * static_cast<float>(i) / static_cast<float>(sides);
    const vec3 outwards(std::sin(angle), 0, std::cos(angle));
    const vec3 normal = glm::normalize(outwards + vec3(0, (lower - upper) / height, 0));
    vertex(foot + lower * outwards, normal);
    vertex(foot + upper * outwards + vec3(0, height, 0), normal);
  }
  for (uint32_t i = first; i < first + 2 * static_cast<uint32_t>(sides); i += 2) quad(i, i + 2, i + 3, i + 1);
}

void Shape::addDisc(const vec3& centre, float radius, int sides) {
  const vec3 up(0, 1, 0);
  const uint32_t middle = vertex(centre, up);
  for (int i = 0; i <= sides; ++i) {
    const float angle = 2 * pi * static_cast<float>(i) / static_cast<float>(sides);
    vertex(centre + radius * vec3(std::sin(angle), 0, std::cos(angle)), up);
  }
  for (uint32_t i = middle + 1; i <= middle + static_cast<uint32_t>(sides); ++i)
    indices.insert(indices.end(), {middle, i, i + 1});
}

void Shape::addSurface(int columns, int rows, const std::function<vec3(float u, float v)>& point) {
  const auto first = static_cast<uint32_t>(positions.size());
  const auto across = static_cast<uint32_t>(columns);
  for (int row = 0; row <= rows; ++row)
    for (int column = 0; column <= columns; ++column) {
      const float u = static_cast<float>(column) / static_cast<float>(columns);
      const float v = static_cast<float>(row) / static_cast<float>(rows);
      constexpr float step = 1e-3f;
      const vec3 alongU = point(u + step, v) - point(u - step, v);
      const vec3 alongV = point(u, v + step) - point(u, v - step);
      vertex(point(u, v), glm::normalize(glm::cross(alongV, alongU)));
    }
  for (uint32_t row = 0; row < static_cast<uint32_t>(rows); ++row)
    for (uint32_t column = 0; column < across; ++column) {
      const uint32_t upper = first + row * (across + 1) + column, lower = upper + across + 1;
      quad(lower, lower + 1, upper + 1, upper);
    }
}

void Shape::addBall(const vec3& centre, float radius) {
  addSurface(96, 48, [=](float u, float v) {
    // A hair off the poles, where the surface has no direction.
    const float polar = pi * (0.002f + 0.996f * v), azimuth = 2 * pi * u;
    return centre + radius * vec3(std::sin(polar) * std::sin(azimuth), std::cos(polar),
                                  std::sin(polar) * std::cos(azimuth));
  });
}

Gltf::Gltf(const std::string& generator) {
  root_["asset"] = {{"version", "2.0"}, {"generator", "sfumato " + generator}};
  root_["extensionsUsed"] = {"KHR_lights_punctual", "KHR_materials_transmission",
                             "KHR_materials_emissive_strength"};
  root_["scene"] = 0;
}

size_t Gltf::addMaterial(const Material& material) {
  json entry = {
      {"name", material.name},
      {"doubleSided", true},
      {"pbrMetallicRoughness",
       {{"baseColorFactor", {material.colour.x, material.colour.y, material.colour.z, material.alpha}},
        {"metallicFactor", 0},
        {"roughnessFactor", material.roughness}}}};
  if (material.alpha < 1) entry["alphaMode"] = "BLEND";
  if (material.transmission > 0)
    entry["extensions"]["KHR_materials_transmission"] = {{"transmissionFactor", material.transmission}};
  const float brightest = std::max({material.emission.x, material.emission.y, material.emission.z});
  if (brightest > 0) {
    entry["emissiveFactor"] = toJson(material.emission / brightest);
    entry["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", brightest}};
  }
  if (!material.picture.empty()) {
    const size_t image = add("images", {{"uri", material.picture}});
    entry["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", add("textures", {{"source", image}})}};
  }
  if (!material.extras.is_null()) entry["extras"] = material.extras;
  return add("materials", entry);
}

void Gltf::addShape(const std::string& name, const Shape& shape, size_t material, json placement) {
  json primitive = {
      {"attributes", {{"POSITION", addPositions(shape.positions)}, {"NORMAL", addVectors(shape.normals)}}},
      {"indices", addIndices(shape.indices)},
      {"material", material}};
  if (!shape.uvs.empty()) primitive["attributes"]["TEXCOORD_0"] = addVectors(shape.uvs);
  placement["mesh"] = add("meshes", {{"name", name}, {"primitives", {primitive}}});
  addNode(name, std::move(placement));
}

void Gltf::addLight(const std::string& name, json light, const json& placement) {
  light["name"] = name;
  json& lights = root_["extensions"]["KHR_lights_punctual"]["lights"];
  lights.push_back(light);
  json node = placement;
  node["extensions"]["KHR_lights_punctual"]["light"] = lights.size() - 1;
  addNode(name, node);
}

void Gltf::addCamera(const std::string& name, float yfov, json placement) {
  placement["camera"] =
      add("cameras",
          {{"name", name}, {"type", "perspective"}, {"perspective", {{"yfov", yfov}, {"znear", 0.05}}}});
  addNode(name, std::move(placement));
}

void Gltf::addNode(const std::string& name, json node) {
  node["name"] = name;
  root_["scenes"][0]["nodes"].push_back(add("nodes", node));
}

void Gltf::setAmbient(const vec3& radiance) {
  root_["scenes"][0]["extras"]["ambient"] = toJson(radiance);
}

void Gltf::write(const std::filesystem::path& path) {
  std::filesystem::path bin = path;
  bin.replace_extension(".bin");
  root_["buffers"] = {{{"uri", bin.filename().string()}, {"byteLength", buffer_.size()}}};
  base::writeFile(bin, buffer_);
  base::writeFile(path, root_.dump(1) + "\n");
}

size_t Gltf::add(const char* list, const json& entry) {
  root_[list].push_back(entry);
  return root_[list].size() - 1;
}

template <typename T>
size_t Gltf::addAccessor(const std::vector<T>& values, json accessor) {
  const size_t bytes = values.size() * sizeof(T);
  accessor["bufferView"] =
      add("bufferViews", {{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", bytes}});
  accessor["count"] = values.size();
  buffer_.append(reinterpret_cast<const char*>(values.data()), bytes);
  return add("accessors", accessor);
}

size_t Gltf::addIndices(const std::vector<uint32_t>& indices) {
  constexpr int unsignedInt = 5125;
  return addAccessor(indices, {{"componentType", unsignedInt}, {"type", "SCALAR"}});
}

template <typename T>
size_t Gltf::addVectors(const std::vector<T>& vectors, json accessor) {
  constexpr int floatType = 5126;
  accessor["componentType"] = floatType;
  accessor["type"] = sizeof(T) == sizeof(vec2) ? "VEC2" : "VEC3";
  return addAccessor(vectors, accessor);
}

size_t Gltf::addPositions(const std::vector<vec3>& positions) {
  vec3 low = positions.front(), high = low;
  for (const vec3& p : positions) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  return addVectors(positions, {{"min", toJson(low)}, {"max", toJson(high)}});
}

json toJson(const vec3& v) {
  return {v.x, v.y, v.z};
}

json at(const vec3& position) {
  return {{"translation", toJson(position)}};
}

json turned(const vec3& position, float angle) {
  return {{"translation", toJson(position)}, {"rotation", {0, std::sin(angle / 2), 0, std::cos(angle / 2)}}};
}

json lookingAt(const vec3& eye, const vec3& target) {
  const vec3 z = glm::normalize(eye - target);
  const vec3 x = glm::normalize(glm::cross(vec3(0, 1, 0), z));
  const vec3 y = glm::cross(z, x);
  return {{"matrix", {x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, eye.x, eye.y, eye.z, 1}}};
}

int makeScenes(const char* name, int argumentCount, char** arguments,
               const std::function<void(const std::filesystem::path& folder)>& make) {
  using base::ExitCode;
  if (argumentCount != 2) {
    std::fprintf(stderr, "usage: %s FOLDER\n", name);
    return static_cast<int>(ExitCode::Usage);
  }
  try {
    std::filesystem::create_directories(arguments[1]);
    make(arguments[1]);
    return 0;
  } catch (const base::Error& error) {
    std::fprintf(stderr, "%s: error: %s\n", name, error.what());
    return static_cast<int>(error.exitCode);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: error: %s: cannot be written: %s\n", name, arguments[1], error.what());
    return static_cast<int>(ExitCode::Input);
  }
}

}  // namespace sfumato::demos
