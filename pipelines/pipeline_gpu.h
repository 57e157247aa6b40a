// A way to draw a frame. All of them draw the same scenes, with the same materials and lights.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "gl/device.h"
#include "pipelines/frame_gpu.h"
#include "pipelines/quality.h"
#include "pipelines/scene_gpu.h"
#include "scene/scene.h"
#include "volumes/grid.h"
#include "volumes/volumes_gpu.h"

namespace sfumato::pipelines {

class Pipeline {
 public:
  // Uploads what the scene holds; it must outlive the pipeline.
  Pipeline(gl::Device& device, const scene::Scene& scene, std::span<const volumes::Medium> media,
           const volumes::GridOptions& gridOptions = {})
      : scene_(device, scene, media, gridOptions) {}
  virtual ~Pipeline() = default;
  // Compiles what takes longest of what such frames are drawn with, as a part of the start-up; all else is
  // compiled when it is first used.
  virtual void prepare(const scene::Camera& /*camera*/, int /*height*/, const Quality& /*quality*/,
                       const FrameOptions& /*options*/) {}
  virtual Frame render(const scene::Camera& camera, int width, int height, const Quality& quality,
                       const FrameOptions& options = {}) = 0;
  const SceneGpu& scene() const { return scene_; }

 protected:
  SceneGpu scene_;
};

// The one of a name (pipelines/pipeline_names.h), with the scene uploaded; the scene must outlive it.
std::unique_ptr<Pipeline> makePipeline(const std::string& name, gl::Device& device, const scene::Scene& scene,
                                       std::span<const volumes::Medium> media,
                                       const volumes::GridOptions& gridOptions = {});

}  // namespace sfumato::pipelines
