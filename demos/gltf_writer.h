// What the programs that make demo scenes share: shapes, materials, and a glTF file in the making.
#pragma once

#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace sfumato::demos {

constexpr float pi = 3.14159265f;

// Triangles of one material.
struct Shape {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;
  std::vector<glm::vec2> uvs;  // of all vertices, or empty
  std::vector<uint32_t> indices;

  uint32_t vertex(const glm::vec3& position, const glm::vec3& normal);
  // The four corners counter-clockwise, seen from the front.
  void quad(uint32_t a, uint32_t b, uint32_t c, uint32_t d);
  // A parallelogram: `corner` and two edges.
  void addPlane(const glm::vec3& corner, const glm::vec3& right, const glm::vec3& up);
  void addBox(const glm::vec3& low, const glm::vec3& high);
  // Upright, open at both ends; its radius goes from `lower` to `upper`.
  void addTube(const glm::vec3& foot, float height, float lower, float upper, int sides = 48);
  // A level disc that looks up.
  void addDisc(const glm::vec3& centre, float radius, int sides = 48);
  // A sphere, with a pinhole at its poles.
  void addBall(const glm::vec3& centre, float radius);
  // A grid over u and v in [0, 1], seen from where cross(dP/dv, dP/du) points to.
  void addSurface(int columns, int rows, const std::function<glm::vec3(float u, float v)>& point);
};

struct Material {
  std::string name;
  glm::vec3 colour{1.f};
  float roughness = 0.9f;
  float alpha = 1;
  float transmission = 0;   // of the light that its alpha stops, what passes in its colour
  glm::vec3 emission{0.f};  // radiance
  std::string picture;      // path of the base colour's texture, relative to the glTF; empty: none
  nlohmann::json extras;    // null: none
};

// A glTF file in the making; indices are as in the format.
class Gltf {
 public:
  explicit Gltf(const std::string& generator);

  size_t addMaterial(const Material& material);
  void addShape(const std::string& name, const Shape& shape, size_t material,
                nlohmann::json placement = nlohmann::json::object());
  void addLight(const std::string& name, nlohmann::json light, const nlohmann::json& placement);
  void addCamera(const std::string& name, float yfov, nlohmann::json placement);
  void addNode(const std::string& name, nlohmann::json node);
  void setAmbient(const glm::vec3& radiance);
  // Writes `path` and its buffer, PATH with the ending .bin.
  void write(const std::filesystem::path& path);

 private:
  size_t add(const char* list, const nlohmann::json& entry);
  template <typename T>
  size_t addAccessor(const std::vector<T>& values, nlohmann::json accessor);
  size_t addIndices(const std::vector<uint32_t>& indices);
  template <typename T>
  size_t addVectors(const std::vector<T>& vectors, nlohmann::json accessor = nlohmann::json::object());
  size_t addPositions(const std::vector<glm::vec3>& positions);

  nlohmann::json root_;
  std::string buffer_;
};

nlohmann::json toJson(const glm::vec3& v);
// Placements of nodes.
nlohmann::json at(const glm::vec3& position);
// Turned about the vertical by `angle` radians.
nlohmann::json turned(const glm::vec3& position, float angle);
// For a camera or a light: at `eye`, its -Z towards `target`, which is not straight above or below.
nlohmann::json lookingAt(const glm::vec3& eye, const glm::vec3& target);

// The main function of a program `name` that makes scenes in the folder it is given: 0, or the exit code of
// the error that it prints.
int makeScenes(const char* name, int argumentCount, char** arguments,
               const std::function<void(const std::filesystem::path& folder)>& make);

}  // namespace sfumato::demos
