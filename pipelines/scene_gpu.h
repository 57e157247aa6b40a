// A scene on the device, what a camera sees of it, and the deep shadow maps of its lights: what every
// pipeline starts a frame with.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "deepshadow/maps_gpu.h"
#include "gl/device.h"
#include "lights/light_lists_gpu.h"
#include "pipelines/ambient_occlusion_gpu.h"
#include "pipelines/frame_gpu.h"
#include "pipelines/geometry_gpu.h"
#include "pipelines/quality.h"
#include "scene/scene.h"
#include "shaders/shared/resolve.h"
#include "shaders/shared/view.h"
#include "volumes/grid.h"
#include "volumes/volumes_gpu.h"

namespace sfumato::pipelines {

struct FrameView {
  scene::Camera camera;
  int width = 0;  // pixels
  int height = 0;
  std::vector<std::vector<glm::dvec3>> seen;  // of each instance: scene/visible_hull.h
  // Of the whole image, with clip planes close around the surfaces that are seen: it shows the same, and the
  // depth test tells more depths apart. With what scales their depths below 1.
  shared::ViewParams params{};

  // The pixels in which an instance may be seen, of which something is: x, y from the bottom, width, height.
  // Never too small.
  glm::ivec4 areaOf(size_t instance) const;
};

FrameView viewOf(const scene::Scene& scene, const scene::Camera& camera, int width, int height);

// What the shadow maps of a view are built from.
struct ShadowInputs {
  deepshadow::Casters casters;
  std::vector<glm::dvec3> receivers;      // their hull holds what is seen
  std::vector<glm::dvec3> castingPoints;  // and theirs what casts shadows
  std::vector<int> resolutions;           // of each light: shadow_resolution.h
  deepshadow::MapBudget budget;
};

// What of the geometry casts shadows; draws it, as long as it lives.
deepshadow::Casters castersOf(const GeometryGpu& geometry);

class SceneGpu {
 public:
  // Uploads what the scene holds. The scene must outlive it.
  SceneGpu(gl::Device& device, const scene::Scene& scene, std::span<const volumes::Medium> media,
           const volumes::GridOptions& gridOptions = {});

  gl::Device& device() const { return device_; }
  const scene::Scene& scene() const { return scene_; }
  const std::vector<lights::Light>& lights() const { return scene_.lights; }
  const GeometryGpu& geometry() const { return geometry_; }
  const volumes::VolumesGpu& volumes() const { return volumes_; }

  // Of programs that light surfaces or march through smoke.
  gl::ShaderDefines lightingDefines(const Quality& quality) const;
  // What they are told; rays and samples are the pass's own.
  shared::ResolveParams lightingParams(const Quality& quality, int directionalLights) const;
  // What occlusion such frames have: none where there is no ambient light to take from.
  OcclusionSize occlusionOf(const Quality& quality) const;
  // Of the whole image at once, from a G-buffer of its own, where there is any.
  std::optional<AmbientOcclusion> drawOcclusion(const FrameView& view, const Quality& quality) const;
  ShadowInputs shadowInputs(const FrameView& view, const Quality& quality) const;
  // `former`: see deepshadow::Maps.
  deepshadow::Maps buildShadows(const FrameView& view, const Quality& quality,
                                deepshadow::Maps former = {}) const;

 private:
  gl::Device& device_;
  const scene::Scene& scene_;
  std::vector<glm::dmat4> mediaBoxes_;  // world from unit cube
  GeometryGpu geometry_;
  volumes::VolumesGpu volumes_;
};

// Where the lights find their shadows, of deep or of interlaced maps.
template <typename Maps>
std::vector<lights::ShadowFaces> facesOf(const Maps& maps) {
  std::vector<lights::ShadowFaces> faces;
  for (const auto& map : maps.lights()) faces.push_back({map.firstFace, map.faces});
  return faces;
}

ShadowFigures figuresOf(const deepshadow::Maps& shadows);

}  // namespace sfumato::pipelines
