// Meshes, materials and textures of a scene on the GPU, and the draws over them.
#pragma once

#include <vector>

#include "gl/buffer.h"
#include "gl/commands.h"
#include "gl/device.h"
#include "gl/texture.h"
#include "scene/scene.h"
#include "shaders/shared/geometry.h"

namespace sfumato::pipelines {

enum class Layer { Opaque, Translucent };

class GeometryGpu {
 public:
  // Uploads what the scene's instances use. Costs 72 bytes a vertex, 4 an index, 4 a texel (a third more with
  // mipmaps).
  GeometryGpu(gl::Device& device, const scene::Scene& scene);

  // Draws every instance of a layer with the current draw state; programs start with
  // shaders/scene/surface.vert. `cullBackFaces`: of materials that are not double-sided.
  void draw(Layer layer, bool cullBackFaces) const;
  bool has(Layer layer) const { return !draws(layer).empty(); }
  size_t triangles() const { return triangles_; }

 private:
  struct Draw {
    gl::IndexedRange range;
    int material = 0;
  };
  const std::vector<Draw>& draws(Layer layer) const {
    return layer == Layer::Opaque ? opaque_ : translucent_;
  }
  void uploadMeshes(gl::Device& device, const scene::Scene& scene);
  void uploadMaterials(gl::Device& device, const scene::Scene& scene);
  void bindTextures(int material) const;

  // Textures of a material by unit, index in textures_.
  struct MaterialTextures {
    int unit[MATERIAL_TEXTURES] = {};
    bool doubleSided = false;
  };

  std::vector<Draw> opaque_;
  std::vector<Draw> translucent_;
  std::vector<MaterialTextures> materials_;
  std::vector<gl::Texture> textures_;  // the first one is a white texel
  gl::Buffer vertices_;
  gl::Buffer indices_;
  gl::Buffer drawData_;
  gl::Buffer materialData_;
  gl::VertexArray vertexArray_;
  size_t triangles_ = 0;
};

}  // namespace sfumato::pipelines
