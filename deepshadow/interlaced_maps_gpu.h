// Interlaced transparent shadow maps (Aladagli 2015, section 3.2.1): one pass over all casters, opaque and
// translucent ones together, keeps the nearest surface of every texel; but on even lines translucent ones are
// left out. So odd lines tell of the first translucent surface, and even ones beside them of the opaque one
// behind it. The thesis has them for spot lights; here point lights have six faces and directional ones an
// orthographic one, and lookups filter what comes of the comparison.
//
// What they cannot do, and deep shadow maps (maps_gpu.h) can: of translucent surfaces before one another only
// the nearest to the light filters it; where there is one, edges have half the resolution across the lines;
// smoke casts no shadow; and the flags of materials about shadows of their own object do not hold.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "deepshadow/maps_gpu.h"
#include "gl/buffer.h"
#include "gl/device.h"
#include "gl/texture.h"
#include "lights/light.h"

namespace sfumato::deepshadow {

enum class InterlacedKind {
  // A translucent surface lets t = 1 - a (1 - tau b) through, as everywhere: RGB10A2, so within 1/2046.
  Transmittance,
  // It turns the light I into min(I, C) (1 - alpha), Eq. 3.1 and 3.2, with C = b and alpha = a (1 - tau):
  // RGBA8, Table 3.3. As C is at most 1 and the thesis's light too, while ours are of any intensity, I is the
  // light's colour with 1 as its largest channel: a light of any power keeps its hue. What is kept of C is
  // min(I, C) / I, which is all of it that this light's lookups ask for.
  Thesis,
  // For comparisons: depth alone, half the memory. Whatever takes any light away blocks all of it, as a plain
  // shadow map has it.
  Opaque,
};

// Of programs that look up maps of that kind through shaders/deepshadow/shadows.glsl.
gl::ShaderDefines lookupDefines(InterlacedKind kind);

struct InterlacedInputs {
  std::span<const lights::Light> lights;  // one, or all that one pass asks for
  std::span<const int> resolutions;  // of each light: texels a side, a face of a cube has half; 0: no map
  const Casters& casters;            // `once` and `notSelf` have no meaning here
  std::span<const glm::dvec3> receivers;      // see directionalFace()
  std::span<const glm::dvec3> castingPoints;  // its `casters`
  InterlacedKind kind = InterlacedKind::Transmittance;
};

// Whether all maps of a frame stand in the textures at once, or each light's in its turn in the place of the
// one before.
enum class InterlacedStand { Together, InTurns };

struct InterlacedPlan {
  std::vector<int> resolutions;  // of each light
  bool lowered = false;          // whether that is coarser than was asked for
  size_t budgetBytes = 0;        // of the textures; without a budget what the device draws into
};

// Resolutions for the maps of a frame, as asked for or, where the textures that hold what stands at once
// would be larger than the budget or than the device's are, lower ones that fit, evenly (map_plan.h). All
// lights are those of `inputs`. Throws Memory when nothing fits that the budget allows.
InterlacedPlan planOf(const gl::Device& device, const InterlacedInputs& inputs, const MapBudget& budget,
                      InterlacedStand stand);

class InterlacedMaps {
 public:
  struct LightMap {
    int firstFace = -1;  // among all faces; -1: this light casts no shadow
    int faces = 0;
    int resolution = 0;
  };
  // A face's texels on the CPU, rows from the bottom.
  struct ReadFace {
    FaceProjection projection;
    std::vector<float> depths;          // below 0: of a translucent surface
    std::vector<glm::vec4> letThrough;  // rgb (1 - a) of it; undefined where it is opaque; empty for Opaque
  };

  // Builds the maps of these lights in place of those that it had, whose textures are used again where they
  // are large enough: a pipeline may keep all maps of a frame, or one at a time, each built just before its
  // light is added up. Costs 12 bytes a texel, 8 for Opaque. Throws Memory when there is no room: planOf()
  // tells resolutions that have it.
  void build(gl::Device& device, const InterlacedInputs& inputs);

  const std::vector<LightMap>& lights() const { return lights_; }  // in the order of the inputs
  size_t bytes() const;                                            // of all textures
  // For shaders that include shaders/deepshadow/shadows.glsl, with the defines of the kind of the maps.
  void bind() const;
  ReadFace read(size_t face) const;

 private:
  // Where a face stands in the textures.
  struct Face {
    FaceProjection projection;
    glm::ivec2 corner;
  };
  glm::ivec2 arrange(const gl::Device& device, const InterlacedInputs& inputs);
  void reserve(gl::Device& device, const glm::ivec2& size, InterlacedKind kind);
  void draw(gl::Device& device, const InterlacedInputs& inputs) const;

  std::vector<LightMap> lights_;
  std::vector<Face> faces_;
  std::vector<glm::vec3> lightColours_;  // of each face
  gl::Records faceData_;
  gl::Texture depths_;
  gl::Texture filters_;
  gl::Texture depthTest_;
};

}  // namespace sfumato::deepshadow
