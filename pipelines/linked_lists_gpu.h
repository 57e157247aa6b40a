// The core pipeline, after Lindbeck 2015: opaque G-buffer, light linked lists, deep shadow maps, exact
// per-pixel lists of translucent surfaces, and a resolve that walks a pixel's surfaces and marches the smoke
// between them.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "deepshadow/maps_gpu.h"
#include "gl/device.h"
#include "image/image.h"
#include "lights/light_lists_gpu.h"
#include "lists/linked_lists_gpu.h"
#include "pipelines/geometry_gpu.h"
#include "pipelines/quality.h"
#include "scene/scene.h"
#include "volumes/grid.h"
#include "volumes/volumes_gpu.h"

namespace sfumato::pipelines {

struct FrameStatistics {
  lists::ListStatistics surfaces;             // of the camera
  lists::ListStatistics lights;               // light lists
  std::vector<deepshadow::LightMap> shadows;  // a light each, as in the scene
  size_t splitPixels = 0;                     // walked sample by sample
  int resolveDispatches = 0;
  size_t cutWalks = 0;  // 0, or walks that a bound cut: the picture is then wrong, and the user is told
  size_t triangles = 0;
};

struct Frame {
  image::Image radiance;  // linear RGB
  FrameStatistics statistics;
};

class LinkedListsPipeline {
 public:
  // Uploads what the scene holds and compiles the shaders: the start-up, apart from the frame.
  LinkedListsPipeline(gl::Device& device, const scene::Scene& scene, std::span<const volumes::Medium> media);

  // Draws one frame. Bytes: 40 a sample for the G-buffer, 32 a ray, 52 a translucent fragment, and those of
  // the light lists and deep shadow maps. Throws Memory when a buffer would be over the device's limit.
  Frame render(const scene::Camera& camera, int width, int height, const Quality& quality);

 private:
  gl::Device& device_;
  const scene::Scene& scene_;
  std::vector<glm::dmat4> mediaBoxes_;  // world from unit cube
  GeometryGpu geometry_;
  volumes::VolumesGpu volumes_;
};

}  // namespace sfumato::pipelines
