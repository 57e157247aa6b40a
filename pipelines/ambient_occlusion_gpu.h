// How much of the ambient light gets to what the camera sees, told from a depth buffer alone (SSAO: Ferko,
// "Real-time Lighting Effects using Deferred Shading", CESCG 2012, section 5; after Mittring 2007).
#pragma once

#include "gl/buffer.h"
#include "gl/device.h"
#include "gl/program.h"
#include "gl/texture.h"
#include "pipelines/ambient_occlusion.h"

namespace sfumato::pipelines {

struct AmbientOcclusionInputs {
  const gl::Texture& depth;     // R32F: m along -Z of the view at the pixels' centres; 3e38: nothing
  const gl::Texture& surface0;  // RGBA32UI: words 0-3 of shared::PackedSurface
  const gl::Buffer& view;       // shared::ViewParams of the whole image, as large as both textures
  int width = 0;                // pixels
  int height = 0;
  AmbientOcclusionOptions options;  // not Off
  // Of the blur's weights (equation 3), in radii: the distance between surfaces at which they have fallen to
  // half. A large one makes it an ordinary Gaussian.
  double surfacesApart = 0.02;
  double blurredWithin = 0.3;  // radii: places farther apart share nothing
};

// Of each block of pixels, RGBA32UI: see shaders/pipelines/occlusion.glsl. A flat surface by itself, what is
// more than the radius away from everything else, and what is hidden by something farther in front have an
// occlusion of exactly 0.
struct AmbientOcclusion {
  gl::Texture occlusion;

  void bind() const;
};

// Of programs that light surfaces with shaders/pipelines/accessibility.glsl; none where it is off.
gl::ShaderDefines occlusionDefines(OcclusionSize size);

// Without random input: the same picture gives the same bits. Costs 16 bytes a result, 16 more while it
// works.
AmbientOcclusion drawAmbientOcclusion(gl::Device& device, const AmbientOcclusionInputs& inputs);

}  // namespace sfumato::pipelines
