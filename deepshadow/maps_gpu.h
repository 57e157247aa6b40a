// Deep shadow maps: for every texel of a light the transmittance as a function of depth, through coloured
// surfaces and smoke (Lindbeck 2015, section 2.2; Lokovic and Veach 2000). Per light: opaque depth first, so
// that nothing behind it is ever stored; then translucent surfaces into sorted lists, and from these into
// knots with the optical depth summed up; then, along rays of its own, a march through the smoke. Smoke
// varies no faster than from voxel to voxel: its texels are as wide as a step of the march, where that is
// more than a texel of the surfaces, and lookups interpolate between them.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "deepshadow/map_plan.h"
#include "deepshadow/read_map.h"
#include "deepshadow/shadow_faces.h"
#include "gl/buffer.h"
#include "gl/device.h"
#include "gl/texture.h"
#include "lights/light.h"
#include "lists/lists_gpu.h"
#include "shaders/shared/deepshadow.h"
#include "volumes/volumes_gpu.h"

namespace sfumato::deepshadow {

// Draw calls for everything that casts shadows, with the draw state that is current; programs start with
// shaders/scene/surface.vert.
struct Casters {
  std::function<void()> opaque;  // empty: none
  std::function<void()> listed;  // translucent ones, opaque ones that do not shadow themselves; empty: none
  bool once = false;             // whether there are objects that shadow once
  bool notSelf = false;          // whether there are objects that do not shadow themselves
  gl::ShaderDefines defines;     // of the programs that they are drawn with

  bool any() const { return opaque || listed; }
};

struct MapInputs {
  const std::vector<lights::Light>& lights;
  const Casters& casters;
  const volumes::VolumesGpu& volumes;
  const std::vector<glm::dvec3>& receivers;      // see directionalFace()
  const std::vector<glm::dvec3>& castingPoints;  // its `casters`
  MapPlan plan;                                  // what is asked for; a face of a cube has half a side
  MapBudget budget{};
  double stepVoxels = 1.5;  // of the march through smoke, and the width of its texels
  lists::ListOptions lists{};
  // For comparisons: lists stay linked, with opaque surfaces in them and so many nodes of smoke for each
  // texel (deepshadow/walk.glsl; Lindbeck 2015, 2.2); 0: runs of knots. Error bound, budgets and the flags of
  // objects do not hold then.
  int linkedSmokeNodes = 0;
};

struct LightMap {
  int firstFace = -1;  // among all faces; -1: this light casts no shadow
  int faces = 0;
  int resolution = 0;  // texels a side; a face of a cube has half
  size_t firstTexel = 0;
  size_t texels = 0;       // of surfaces; one of a face where none cast shadows
  size_t smokeTexels = 0;  // of each face behind its others
  size_t smokeKnots = 0;   // at most
  size_t knotBytes = 0;
  size_t firstUnit = 0;  // of the pool, whose units are 16 bytes; some are not used, or of other lights
  size_t units = 0;
  size_t nodes = 0;   // of the lists that surfaces were sorted in
  size_t hidden = 0;  // of these, behind the opaque depth
};

class Maps {
 public:
  Maps() = default;
  // Builds the maps that the plan asks for, or, where they are more than the budget, of a coarser plan that
  // fits (map_plan.h): what they take is counted beforehand, at an eighth of the resolution. Costs 12 bytes a
  // texel and 8 a knot of a texel whose smoke or surfaces are grey, 16 a knot of others, of smoke half of
  // these where its bound allows that; while it builds, 8 bytes a texel of a window and 16 a translucent
  // surface in it, more with some strategies (lists/lists_gpu.h). Throws Memory when no plan fits that the
  // budget allows, or one texel's lists are over theirs. Memory of `former` maps, as of the frame before, is
  // used again.
  Maps(gl::Device& device, const MapInputs& inputs, Maps former);
  Maps(gl::Device& device, const MapInputs& inputs) : Maps(device, inputs, Maps()) {}

  const std::vector<LightMap>& lights() const { return lightMaps_; }  // in the order of MapInputs::lights
  const lists::ListStatistics& lists() const { return lists_; }       // of all lights
  const MapPlan& plan() const { return plan_; }                       // what they were built with
  bool lowered() const { return lowered_; }                           // whether that is coarser than asked
  size_t bytes() const;                                               // of texels and knots
  size_t predictedBytes() const { return predictedBytes_; }           // that were counted; 0: no need
  size_t budgetBytes() const { return budgetBytes_; }
  const std::vector<FaceProjection>& faces(size_t light) const { return projections_[light]; }
  // Texels whose march through smoke was cut at its bound, so that it is coarser than it should be; 0 unless
  // steps are absurdly short. Lists of surfaces are walked to their end, in several dispatches if need be.
  size_t cutMarches() const { return cutMarches_; }
  // For shaders that include shaders/deepshadow/lookup.glsl.
  void bind() const;
  // A light's map, read back, with the smoke as it is looked up in the middle of each texel.
  ReadMap read(size_t light) const;
  // At most, of what read() gives.
  size_t knotsAtMost(size_t light) const;

 private:
  size_t arrange(const MapInputs& inputs);
  int smokeSideOf(const MapInputs& inputs, size_t light) const;
  bool tryBuild(gl::Device& device, const MapInputs& inputs, size_t texels, size_t units);
  void provideTexels(gl::Device& device, size_t texels);
  void buildLinked(gl::Device& device, const MapInputs& inputs, size_t texels);
  void uploadFaces(gl::Device& device);

  MapPlan plan_;
  bool lowered_ = false;
  size_t budgetBytes_ = 0;
  size_t predictedBytes_ = 0;
  std::vector<LightMap> lightMaps_;
  lists::ListStatistics lists_;
  std::vector<std::vector<FaceProjection>> projections_;  // of each light
  gl::Records faces_;
  gl::Buffer texels_;
  gl::Buffer knots_;
  gl::BufferTexture texelsView_;
  gl::BufferTexture knotsView_;
  size_t cutMarches_ = 0;
  std::optional<lists::Lists> linked_;
};

}  // namespace sfumato::deepshadow
