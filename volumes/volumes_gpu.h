// Media on the GPU: one 3D texture of density each, and what shaders/volumes/media.glsl reads.
#pragma once

#include <span>
#include <vector>

#include "gl/buffer.h"
#include "gl/device.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "volumes/grid.h"

namespace sfumato::volumes {

class VolumesGpu {
 public:
  // Uploads every medium: 4 bytes a voxel. Throws Memory when a grid is over the device's 3D texture limit,
  // or there are more media than texture units for them.
  VolumesGpu(gl::Device& device, std::span<const Medium> media);

  size_t count() const { return textures_.size(); }
  bool empty() const { return textures_.empty(); }
  // VOLUME_COUNT, and COLOURED_SMOKE where the extinction of some medium has a colour; for programs that
  // include shaders/volumes/media.glsl.
  gl::ShaderDefines defines() const;
  void bind() const;

 private:
  std::vector<gl::Texture> textures_;
  gl::Buffer data_;
  bool coloured_ = false;
};

}  // namespace sfumato::volumes
