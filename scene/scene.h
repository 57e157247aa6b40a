// A scene as plain values: what files give, what passes are fed from. World space is metres, right-handed, Y
// up.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "lights/light.h"
#include "scene/sampling.h"
#include "volumes/fire.h"

namespace sfumato::scene {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Looks along -Z of its own space, Y up, as in glTF.
struct Camera {
  std::string name;
  glm::dmat4 worldFromView{1.0};  // rotation and translation only
  bool orthographic = false;
  double yfov = 0.8;           // radians, perspective: full vertical angle, in (0, pi)
  double yMagnitude = 1;       // metres, orthographic: half the height seen
  double nearDistance = 0.01;  // metres, > 0 for perspective; what is nearer (surface or smoke) is not seen
  double farDistance = infinity;  // metres, > nearDistance; what is farther is not seen
};

using lights::Light;
using lights::LightType;

// 8-bit RGBA as stored in the file; the use says whether RGB is sRGB (base colour, emissive, specular
// colour).
struct Texture {
  std::string name;
  int width = 0;
  int height = 0;
  std::vector<uint8_t> rgba;  // width * height * 4, rows from the top
  Wrap wrapS = Wrap::Repeat;
  Wrap wrapT = Wrap::Repeat;
  bool nearest = false;  // magnification filter
  Minify minify = Minify::LinearMipmapLinear;
};

struct TextureUse {
  int texture = -1;                // index in Scene::textures, -1: none (reads as 1, or a flat normal)
  int uvSet = 0;                   // 0 or 1
  glm::mat3x2 textureFromUv{1.f};  // affine: what stands to the left of (u, v, 1)
};

enum class AlphaMode { Opaque, Mask, Blend };

// glTF metallic-roughness with KHR_materials_specular and KHR_materials_transmission (thin).
struct Material {
  std::string name;
  glm::vec4 baseColour{1.f};  // linear, alpha
  TextureUse baseColourTexture;
  float metallic = 1.f;
  float roughness = 1.f;
  TextureUse metallicRoughnessTexture;  // G roughness, B metallic
  TextureUse normalTexture;
  float normalScale = 1.f;
  glm::vec3 emissive{0.f};
  TextureUse emissiveTexture;
  AlphaMode alphaMode = AlphaMode::Opaque;
  float alphaCutoff = 0.5f;
  bool doubleSided = false;
  float transmission = 0.f;
  TextureUse transmissionTexture;  // R
  float specular = 1.f;
  TextureUse specularTexture;  // A
  glm::vec3 specularColour{1.f};
  TextureUse specularColourTexture;
  bool unlit = false;  // emits its base colour times alpha and reflects nothing, whatever stands above
  // How an instance of this material shadows (Lindbeck 2015, section 2.2.4 and figure 3.4).
  bool shadowSelf = true;   // false: no surface of an instance is shadowed by the same instance
  bool shadowOnce = false;  // true: of an instance's translucent surfaces light meets only the first
  float shadowRim = 0.f;    // k >= 0: light passes as t^(1 + k (1 / |cos| - 1)); 1 is a thin shell's law

  // Lets light through (BLEND or transmissive), so it lives in lists, not in the G-buffer.
  bool translucent() const { return alphaMode == AlphaMode::Blend || transmission > 0.f; }
};

struct Vertex {
  glm::vec3 position{0.f};
  glm::vec3 normal{0.f, 0.f, 1.f};
  glm::vec4 tangent{1.f, 0.f, 0.f, 1.f};  // w: handedness of the bitangent
  glm::vec2 uv0{0.f};
  glm::vec2 uv1{0.f};
  glm::vec4 colour{1.f};
};

// One glTF primitive: indexed triangles of one material.
struct Mesh {
  std::string name;
  std::vector<Vertex> vertices;
  std::vector<uint32_t> indices;  // three for each triangle, each < vertices.size()
  int material = 0;               // index in Scene::materials
};

struct Instance {
  int mesh = 0;  // index in Scene::meshes
  glm::dmat4 worldFromObject{1.0};
};

// What glows in a volume: another grid of its file.
struct FirePlacement {
  std::string gridName;  // empty: nothing
  volumes::FireLook look;
  int lights = 0;  // how many point lights stand for its light: see scene/fire_lights.h
};

// Where a volume stands and what it is made of; the grid itself is read by the volumes room.
struct VolumePlacement {
  std::string file;                // path, already relative to the working directory
  std::string gridName;            // empty: the file's only float grid, or "density"
  double scale = 1;                // sigma_t per unit of density, 1/m, >= 0
  glm::dvec3 extinctionColour{1};  // what sigma_t is multiplied by per channel, each >= 0
  glm::dvec3 albedo{0.9};          // each in [0, 1]
  double g = 0;                    // Henyey-Greenstein, in (-1, 1)
  FirePlacement fire;
  glm::dmat4 worldFromGridWorld{1.0};  // the node's transform; the grid's own transform stands to its right
};

struct Scene {
  std::vector<Texture> textures;
  std::vector<Material> materials;
  std::vector<Mesh> meshes;
  std::vector<Instance> instances;
  std::vector<Light> lights;
  std::vector<Camera> cameras;
  std::vector<VolumePlacement> volumes;
  // Radiance that arrives from all directions at once, each channel >= 0. A surface returns
  // ambient * (diffuse * (1 - max f0) + f0) of it, f0 weighted by alpha, whatever it looks like from aside: a
  // white one as much as arrives, a metal its colour. Nothing shadows it but what --ssao finds; smoke
  // scatters none of it, and the background stays black.
  glm::dvec3 ambient{0};
};

}  // namespace sfumato::scene
