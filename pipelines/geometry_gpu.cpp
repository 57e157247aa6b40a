#include "pipelines/geometry_gpu.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <numeric>

#include "base/error.h"
#include "shaders/shared/bindings.h"

namespace sfumato::pipelines {

using scene::AlphaMode;
using scene::Instance;
using scene::Material;
using scene::Mesh;
using scene::Scene;
using scene::Texture;
using scene::TextureUse;
using scene::Vertex;

namespace {

constexpr gl::VertexAttribute vertexAttributes[] = {
    {0, 3, offsetof(Vertex, position)}, {1, 3, offsetof(Vertex, normal)}, {2, 4, offsetof(Vertex, tangent)},
    {3, 2, offsetof(Vertex, uv0)},      {4, 2, offsetof(Vertex, uv1)},    {5, 4, offsetof(Vertex, colour)}};
constexpr int drawNumberLocation = 6;

// Every texture use of a material with its unit and whether its RGB is sRGB.
struct UsedTexture {
  const TextureUse& use;
  int unit;
  bool srgb;
};

std::array<UsedTexture, MATERIAL_TEXTURES> usedTextures(const Material& m) {
  return {{{m.baseColourTexture, TEXTURE_BASE_COLOUR, true},
           {m.metallicRoughnessTexture, TEXTURE_METALLIC_ROUGHNESS, false},
           {m.normalTexture, TEXTURE_NORMAL, false},
           {m.emissiveTexture, TEXTURE_EMISSIVE, true},
           {m.transmissionTexture, TEXTURE_TRANSMISSION, false},
           {m.specularTexture, TEXTURE_SPECULAR, false},
           {m.specularColourTexture, TEXTURE_SPECULAR_COLOUR, true}}};
}

shared::MaterialData materialData(const Material& material) {
  shared::MaterialData data{};
  data.baseColour = material.baseColour;
  data.emissive = glm::vec4(material.emissive, material.alphaCutoff);
  data.specularColour = glm::vec4(material.specularColour, material.specular);
  data.factors = {material.metallic, material.roughness, material.normalScale, material.transmission};
  if (material.alphaMode == AlphaMode::Mask) data.flags.x |= MATERIAL_MASK;
  if (material.alphaMode == AlphaMode::Blend) data.flags.x |= MATERIAL_BLEND;
  if (material.normalTexture.texture >= 0) data.flags.x |= MATERIAL_NORMAL_MAP;
  if (material.unlit) data.flags.x |= MATERIAL_UNLIT;
  for (const UsedTexture& used : usedTextures(material)) {
    data.flags.y |= used.use.uvSet << used.unit;
    const glm::mat2x3 rows = glm::transpose(used.use.textureFromUv);
    for (int row = 0; row < 2; ++row) data.uvTransforms[2 * used.unit + row] = glm::vec4(rows[row], 0);
  }
  data.shadow.x = material.shadowRim;
  return data;
}

// SHADOW_* of the next instance of a material; `objects` counts those that have any.
int shadowObject(const Material& material, int& objects) {
  if (material.shadowSelf && !material.shadowOnce) return 0;
  if (++objects > SHADOW_OBJECT_LIMIT)
    base::fail(base::ExitCode::Input,
               "scene: more than {} objects have shadow_self or shadow_once: join some, or drop the flags",
               SHADOW_OBJECT_LIMIT);
  return objects | (material.shadowSelf ? 0 : SHADOW_NOT_SELF) | (material.shadowOnce ? SHADOW_ONCE : 0);
}

gl::Texture uploadTexture(gl::Device& device, const Texture& texture, bool srgb) {
  gl::TextureDescription description;
  description.format = srgb ? gl::Format::SRGB8A8 : gl::Format::RGBA8;
  description.size = {texture.width, texture.height, 1};
  description.filter = texture.nearest ? gl::Filter::Nearest : gl::Filter::Linear;
  description.minify = texture.minify;
  description.wrapS = texture.wrapS;
  description.wrapT = texture.wrapT;
  return gl::Texture(device, "textures", description, std::as_bytes(std::span(texture.rgba)));
}

}  // namespace

GeometryGpu::GeometryGpu(gl::Device& device, const Scene& scene) {
  uploadMeshes(device, scene);
  uploadMaterials(device, scene);
}

void GeometryGpu::uploadMeshes(gl::Device& device, const Scene& scene) {
  std::vector<Vertex> vertices;
  std::vector<uint32_t> indices;
  std::vector<gl::IndexedRange> meshRanges;
  for (const Mesh& mesh : scene.meshes) {
    meshRanges.push_back(
        {.firstIndex = indices.size(), .indices = mesh.indices.size(), .firstVertex = vertices.size()});
    vertices.insert(vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
    indices.insert(indices.end(), mesh.indices.begin(), mesh.indices.end());
  }

  // Instances of one mesh stand together, so that one draw call draws them all.
  std::vector<size_t> order(scene.instances.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return scene.instances[a].mesh < scene.instances[b].mesh; });
  std::vector<shared::DrawData> drawData;
  int objects = 0;
  instances_.resize(scene.instances.size());
  for (const size_t number : order) {
    const Instance& instance = scene.instances[number];
    const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
    if (mesh.indices.empty()) continue;
    const Material& material = scene.materials[static_cast<size_t>(mesh.material)];
    hasShadowOnce_ = hasShadowOnce_ || material.shadowOnce;
    hasNotSelf_ = hasNotSelf_ || !material.shadowSelf;
    gl::IndexedRange range = meshRanges[static_cast<size_t>(instance.mesh)];
    const bool sameMesh = !draws_.empty() && draws_.back().range.firstIndex == range.firstIndex;
    if (sameMesh) {
      ++draws_.back().range.instances;
    } else {
      range.firstInstance = drawData.size();
      const bool translucent = material.translucent();
      draws_.push_back({range, mesh.material, translucent, translucent || !material.shadowSelf});
    }
    instances_[number] = InstancePlace{draws_.size() - 1, drawData.size()};
    shared::DrawData data{};
    data.worldFromObject = instance.worldFromObject;
    data.normalFromObject = glm::mat4(glm::mat3(glm::transpose(glm::inverse(instance.worldFromObject))));
    data.indices = {mesh.material, static_cast<int>(triangles_), shadowObject(material, objects), 0};
    drawData.push_back(data);
    triangles_ += mesh.indices.size() / 3;
  }

  vertices_ = gl::Buffer(device, "vertices", std::span<const Vertex>(vertices));
  indices_ = gl::Buffer(device, "indices", std::span<const uint32_t>(indices));
  drawData_ = gl::Records(device, "draws", std::span<const shared::DrawData>(drawData));
  vertexArray_ = gl::VertexArray(device, vertices_, sizeof(Vertex), vertexAttributes, indices_,
                                 drawNumberLocation, drawData.size());
}

void GeometryGpu::uploadMaterials(gl::Device& device, const Scene& scene) {
  const Texture white{.name = "white",
                      .width = 1,
                      .height = 1,
                      .rgba = {255, 255, 255, 255},
                      .nearest = true,
                      .minify = scene::Minify::Nearest};
  textures_.push_back(uploadTexture(device, white, false));
  std::map<std::pair<int, bool>, int> uploaded;  // by texture and whether it is sRGB
  std::vector<shared::MaterialData> data;
  for (const Material& material : scene.materials) {
    data.push_back(materialData(material));
    MaterialTextures& textures = materials_.emplace_back();
    textures.doubleSided = material.doubleSided;
    hasMasks_ = hasMasks_ || material.alphaMode == AlphaMode::Mask;
    hasShadowRims_ = hasShadowRims_ || material.shadowRim != 0;
    for (const UsedTexture& used : usedTextures(material)) {
      if (used.use.texture < 0) continue;
      const auto [entry, isNew] =
          uploaded.try_emplace({used.use.texture, used.srgb}, static_cast<int>(textures_.size()));
      if (isNew)
        textures_.push_back(
            uploadTexture(device, scene.textures[static_cast<size_t>(used.use.texture)], used.srgb));
      textures.unit[used.unit] = entry->second;
    }
  }
  materialData_ = gl::Records(device, "materials", std::span<const shared::MaterialData>(data));
}

void GeometryGpu::bindTextures(int material) const {
  const MaterialTextures& textures = materials_[static_cast<size_t>(material)];
  for (unsigned unit = 0; unit < std::size(textures.unit); ++unit)
    textures_[static_cast<size_t>(textures.unit[unit])].bind(unit);
}

bool GeometryGpu::Draw::isIn(Layer layer) const {
  switch (layer) {
    case Layer::Opaque:
      return !translucent;
    case Layer::Translucent:
      return translucent;
    case Layer::ShadowDepth:
      return !listed;
    case Layer::ShadowLists:
      return listed;
  }
  return false;
}

bool GeometryGpu::has(Layer layer) const {
  return std::any_of(draws_.begin(), draws_.end(), [&](const Draw& draw) { return draw.isIn(layer); });
}

gl::ShaderDefines GeometryGpu::defines() const {
  gl::ShaderDefines defines;
  if (textures_.size() > 1) defines.emplace_back("TEXTURES", "1");
  if (hasMasks_) defines.emplace_back("MASKS", "1");
  if (hasShadowRims_) defines.emplace_back("SHADOW_RIMS", "1");
  return defines;
}

const GeometryGpu::Draw* GeometryGpu::drawOf(size_t instance) const {
  return instances_[instance] ? &draws_[instances_[instance]->draw] : nullptr;
}

bool GeometryGpu::isTranslucent(size_t instance) const {
  const Draw* draw = drawOf(instance);
  return draw != nullptr && draw->translucent;
}

bool GeometryGpu::isDoubleSided(size_t instance) const {
  const Draw* draw = drawOf(instance);
  return draw != nullptr && materials_[static_cast<size_t>(draw->material)].doubleSided;
}

void GeometryGpu::drawInstance(size_t instance, gl::Cull cull) const {
  const Draw* draw = drawOf(instance);
  if (draw == nullptr) return;
  drawData_.bind(TEXTURE_DRAWS);
  materialData_.bind(TEXTURE_MATERIALS);
  bindTextures(draw->material);
  gl::setCull(cull);
  gl::IndexedRange range = draw->range;
  range.firstInstance = instances_[instance]->number;
  range.instances = 1;
  gl::drawIndexed(vertexArray_, range);
}

void GeometryGpu::draw(Layer layer, bool cullBackFaces) const {
  drawData_.bind(TEXTURE_DRAWS);
  materialData_.bind(TEXTURE_MATERIALS);
  int boundMaterial = -1;
  for (const Draw& draw : draws_) {
    if (!draw.isIn(layer)) continue;
    if (draw.material != boundMaterial) {
      boundMaterial = draw.material;
      bindTextures(draw.material);
      const bool cull = cullBackFaces && !materials_[static_cast<size_t>(draw.material)].doubleSided;
      gl::setCull(cull ? gl::Cull::Back : gl::Cull::None);
    }
    gl::drawIndexed(vertexArray_, draw.range);
  }
}

}  // namespace sfumato::pipelines
