// The last pass of the core pipeline: rays are walked through surfaces and smoke, and what they saw is the
// frame.
#pragma once

#include "pipelines/ambient_occlusion_gpu.h"
#include "pipelines/deep_gpu.h"
#include "pipelines/ray_pass_gpu.h"

namespace sfumato::pipelines {

// What a frame's rays are walked for.
struct WalkOptions {
  size_t samples;
  int smokeBlockSide;  // pixels
  bool countLookups;
  bool deep;
  bool transmittance;  // of each ray is kept

  bool takesBlocks() const { return smokeBlockSide > 1 && !deep; }
  // Rays that march smoke by themselves, and those that are recorded, are all walked.
  bool passes(const SceneGpu& scene) const { return !deep && (scene.volumes().empty() || takesBlocks()); }
};

// Of the program that walks the rays.
gl::ShaderDefines resolveDefines(const SceneGpu& scene, const Quality& quality, const WalkOptions& options);

struct ResolveInputs {
  RayInputs rays;
  const AmbientOcclusion* occlusion;  // of the image, or null
  DeepLimits deepLimits;
};

// Lights the window's pixels into the frame; false when their rays do not fit one buffer. Bytes: 12 a ray, 24
// with its transmittance, 4 for a list of those that are walked, and 32 for each of these.
bool resolve(gl::Device& device, const ResolveInputs& inputs, Frame& frame);

}  // namespace sfumato::pipelines
