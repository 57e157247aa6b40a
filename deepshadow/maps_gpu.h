// Deep shadow maps: for every texel of a light the transmittance as a function of depth, through coloured
// surfaces and smoke (Lindbeck 2015, section 2.2; Lokovic and Veach 2000). Per light: opaque depth first, so
// that nothing behind it is ever stored; then translucent surfaces into sorted lists; then a march through
// the smoke that joins both into knots with the optical depth summed up.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "deepshadow/shadow_faces.h"
#include "gl/buffer.h"
#include "gl/device.h"
#include "gl/texture.h"
#include "lights/light.h"
#include "lists/lists_gpu.h"
#include "volumes/volumes_gpu.h"

namespace sfumato::deepshadow {

// Draw calls for everything that casts shadows, with the draw state that is current; programs start with
// shaders/scene/surface.vert.
struct Casters {
  std::function<void()> opaque;
  std::function<void()> listed;  // translucent ones, opaque ones that do not shadow themselves; empty: none
  bool once = false;             // whether there are objects that shadow once
  bool notSelf = false;          // whether there are objects that do not shadow themselves
  gl::ShaderDefines defines;     // of the programs that they are drawn with
};

struct MapInputs {
  const std::vector<lights::Light>& lights;
  const Casters& casters;
  const volumes::VolumesGpu& volumes;
  const std::vector<glm::dvec3>& receivers;      // see directionalFace()
  const std::vector<glm::dvec3>& castingPoints;  // its `casters`
  int resolution = 1024;                         // texels a side; a face of a cube has half
  double stepVoxels = 1.5;                       // of the march through smoke
  double error =
      1.0 /
      512;  // bound of the error that compression adds to the transmittance of smoke; 0 keeps every step
  lists::ListOptions lists{};
};

struct LightMap {
  int firstFace = -1;  // among all faces; -1: this light casts no shadow
  int faces = 0;
  size_t firstTexel = 0;
  size_t texels = 0;
  size_t knots = 0;
  lists::ListStatistics lists;
};

class Maps {
 public:
  // Builds the maps of every shadow-casting light. Costs 12 bytes a texel and 16 a knot; while it builds, 8
  // bytes a texel of a window and 16 a translucent surface in it, more with some strategies
  // (lists/lists_gpu.h). Throws Memory when the maps are more than the device reads, or one texel's lists are
  // over the budget.
  Maps(gl::Device& device, const MapInputs& inputs);

  const std::vector<LightMap>& lights() const { return lightMaps_; }  // in the order of MapInputs::lights
  // Texels whose march through smoke or walk over their list was cut at its bound; 0 unless steps are
  // absurdly short or a light passes thousands of objects that shadow once.
  size_t cutMarches() const { return cutMarches_; }
  // For shaders that include shaders/deepshadow/lookup.glsl.
  void bind() const;
  const gl::Buffer& texels() const { return texels_; }
  const gl::Buffer& knots() const { return knots_; }

 private:
  std::vector<LightMap> lightMaps_;
  gl::Buffer faces_;
  gl::Buffer texels_;
  gl::Buffer knots_;
  gl::BufferTexture texelsView_;
  gl::BufferTexture knotsView_;
  size_t cutMarches_ = 0;
};

}  // namespace sfumato::deepshadow
