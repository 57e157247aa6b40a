// Media on the GPU: their grids, and what shaders/volumes/media.glsl reads.
#pragma once

#include <span>
#include <vector>

#include "gl/buffer.h"
#include "gl/device.h"
#include "gl/program.h"
#include "volumes/grid.h"
#include "volumes/grids_gpu.h"

namespace sfumato::volumes {

// Where a medium is, and how fine.
struct MediumExtent {
  glm::dmat4 worldFromUnit;
  double voxel;  // m
};

class VolumesGpu {
 public:
  // Uploads every medium. Throws Memory when its grids do not fit (volumes/grids_gpu.h), or there are more
  // media than texture units for them.
  VolumesGpu(gl::Device& device, std::span<const Medium> media, const GridOptions& options = {});

  size_t count() const { return extents_.size(); }
  bool empty() const { return extents_.empty(); }
  const std::vector<MediumExtent>& extents() const { return extents_; }  // of each medium
  // Passes that see light from fires define FIRE then.
  bool burning() const { return grids_.count() > count(); }
  // VOLUME_COUNT, those of the grids, and COLOURED_SMOKE where the extinction of some medium has a colour;
  // for programs that include shaders/volumes/media.glsl.
  gl::ShaderDefines defines() const;
  void bind() const;

 private:
  std::vector<MediumExtent> extents_;
  GridsGpu grids_;  // the density of each medium, then those of the fires
  gl::Buffer data_;
  gl::Buffer ramps_;  // of the fires
  bool coloured_ = false;
};

}  // namespace sfumato::volumes
