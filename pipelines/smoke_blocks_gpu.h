// Smoke on the image: docs/how_it_works.md.
#pragma once

#include "pipelines/ray_pass_gpu.h"

namespace sfumato::pipelines {

// Smoke that was marched for blocks of the window's pixels (SmokeBlock), where rays may be so far apart.
class SmokeBlocks {
 public:
  SmokeBlocks() = default;

  // `defines`: of programs that march. 48 bytes a block and a pixel of those that are refined, 16 a knot.
  SmokeBlocks(gl::Device& device, const RayInputs& inputs, const gl::ShaderDefines& defines,
              FrameStatistics& statistics);
  void bind() const;

 private:
  // Marches `params.options.w` more blocks.
  void march(gl::Device& device, const RayInputs& inputs, const gl::Program& program,
             shared::ResolveParams params, FrameStatistics& statistics);

  gl::Buffer blocks_;
  gl::Buffer knotBuffer_;
  size_t knots_ = 0;  // in it
  gl::BufferTexture blockTexture_;
  gl::BufferTexture knotTexture_;
};

}  // namespace sfumato::pipelines
