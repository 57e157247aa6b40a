// The opaque surfaces that the camera sees.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "gl/buffer.h"
#include "gl/commands.h"
#include "gl/device.h"
#include "gl/texture.h"
#include "pipelines/geometry_gpu.h"
#include "pipelines/tiles.h"
#include "shaders/shared/resolve.h"

namespace sfumato::pipelines {

// Multisample textures: words 0-3 and 4-7 of shared::PackedSurface, and depth in metres along -Z of the view
// (3e38: nothing). 36 bytes a sample, 8 more with the base colour; 4 more while it is drawn. In scenes
// without opaque surfaces the words take a texel alone, as all depths say that they are not to be read.
struct GBuffer {
  gl::Texture surface0;
  gl::Texture surface1;
  gl::Texture depth;
  std::optional<gl::Texture> baseColour;   // linear RGB, 0: nothing
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
  bool baseColour = false;   // whether it is wanted
  bool depthsFirst = false;
};

GBuffer drawGBuffer(gl::Device& device, const GBufferInputs& inputs);

// Draws the opaque surfaces with a state whose depth test is that texture, `depthsFirst`: first their depths
// alone, so that what is hidden is not shaded (Policarpo and Fonseca 2005, section 3.3.1).
void drawOpaque(gl::Device& device, const GeometryGpu& geometry, gl::DrawState state,
                const gl::Texture& depthTest, bool depthsFirst);

// Tells a pass where the samples of a pixel are.
void setSamples(shared::ResolveParams& params, const GBuffer& gbuffer);

}  // namespace sfumato::pipelines
