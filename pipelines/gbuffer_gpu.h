// The opaque surfaces that the camera sees.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "gl/buffer.h"
#include "gl/device.h"
#include "gl/texture.h"
#include "pipelines/geometry_gpu.h"
#include "pipelines/tiles.h"

namespace sfumato::pipelines {

// Multisample textures: words 0-3 and 4-7 of shared::PackedSurface, and depth in metres along -Z of the view
// (3e38: nothing). 36 bytes a sample; 40 while it is drawn.
struct GBuffer {
  gl::Texture surface0;
  gl::Texture surface1;
  gl::Texture depth;
  Tile tile;                               // of the image
  std::vector<glm::vec2> samplePositions;  // in the pixel, [0, 1]^2 from its lower left corner
};

struct GBufferInputs {
  const GeometryGpu& geometry;
  const gl::Buffer& view;  // shared::ViewParams
  int width = 0;           // of the image, pixels
  int height = 0;
  int samples = 1;           // a pixel
  std::optional<Tile> tile;  // as in the view; none: the whole image
};

GBuffer drawGBuffer(gl::Device& device, const GBufferInputs& inputs);

}  // namespace sfumato::pipelines
