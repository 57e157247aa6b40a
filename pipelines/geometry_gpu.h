// Meshes, materials and textures of a scene on the GPU, and the draws over them.
#pragma once

#include <optional>
#include <vector>

#include "gl/buffer.h"
#include "gl/commands.h"
#include "gl/device.h"
#include "gl/texture.h"
#include "scene/scene.h"
#include "shaders/shared/geometry.h"

namespace sfumato::pipelines {

// What the camera sees, and what a light's map takes as a depth and as lists: opaque instances that do not
// shadow themselves are listed with the translucent ones.
enum class Layer { Opaque, Translucent, ShadowDepth, ShadowLists };

class GeometryGpu {
 public:
  // Uploads what the scene's instances use. Throws Input over SHADOW_OBJECT_LIMIT instances of materials that
  // say how they shadow. Costs 72 bytes a vertex, 4 an index, 4 a texel (a third more with mipmaps).
  GeometryGpu(gl::Device& device, const scene::Scene& scene);

  // Draws every instance of a layer with the current draw state; programs start with
  // shaders/scene/surface.vert. `cullBackFaces`: of materials that are not double-sided.
  void draw(Layer layer, bool cullBackFaces) const;
  bool has(Layer layer) const;
  // The same for one instance of the scene, by its number there, and the faces that are not culled.
  void drawInstance(size_t instance, gl::Cull cull) const;
  bool isTranslucent(size_t instance) const;
  bool isDoubleSided(size_t instance) const;
  // For the programs that it is drawn with.
  gl::ShaderDefines defines() const;
  bool hasShadowOnce() const { return hasShadowOnce_; }  // any material
  bool hasNotSelf() const { return hasNotSelf_; }        // any material that does not shadow its own instance
  size_t triangles() const { return triangles_; }

 private:
  struct Draw {
    gl::IndexedRange range;
    int material = 0;
    bool translucent = false;
    bool listed = false;
    bool isIn(Layer layer) const;
  };
  void uploadMeshes(gl::Device& device, const scene::Scene& scene);
  void uploadMaterials(gl::Device& device, const scene::Scene& scene);
  void bindTextures(int material) const;

  // Textures of a material by unit, index in textures_.
  struct MaterialTextures {
    int unit[MATERIAL_TEXTURES] = {};
    bool doubleSided = false;
  };

  // Where an instance of the scene is drawn.
  struct InstancePlace {
    size_t draw = 0;    // index in draws_
    size_t number = 0;  // of the instance in drawData_
  };

  std::vector<Draw> draws_;
  const Draw* drawOf(size_t instance) const;
  std::vector<std::optional<InstancePlace>> instances_;  // none: nothing to draw
  std::vector<MaterialTextures> materials_;
  std::vector<gl::Texture> textures_;  // the first one is a white texel
  gl::Buffer vertices_;
  gl::Buffer indices_;
  gl::Records drawData_;
  gl::Records materialData_;
  gl::VertexArray vertexArray_;
  size_t triangles_ = 0;
  bool hasShadowOnce_ = false;
  bool hasNotSelf_ = false;
  bool hasMasks_ = false;
  bool hasShadowRims_ = false;
};

}  // namespace sfumato::pipelines
