// Known scenes as the core pipeline and the reference draw them.
#pragma once

#include "pipelines/linked_lists_gpu.h"
#include "pipelines/reference.h"
#include "tests/gl/test_device.h"
#include "tests/pipelines/frame_errors.h"
#include "tests/pipelines/known_scenes.h"

namespace sfumato::pipelines {

// Anti-aliased, with maps that are quickly built.
inline Quality smooth(double stepVoxels = fine.stepVoxels) {
  Quality quality = fine;
  quality.samples = 4;
  quality.shadowResolution = 256;
  quality.stepVoxels = stepVoxels;
  return quality;
}

// For a fixture of frames of so many pixels.
template <int width, int height>
class FrameTest : public tests::GpuTest {
 protected:
  Frame draw(const tests::KnownScene& known, const Quality& quality, const FrameOptions& options = {}) {
    LinkedListsPipeline pipeline(device(), known.scene, known.media);
    return pipeline.render(known.scene.cameras[0], width, height, quality, options);
  }

  // Its size aside, by the options.
  static image::Image referenceOf(const tests::KnownScene& known, ReferenceOptions options = {}) {
    options.width = width;
    options.height = height;
    return renderReference(known.scene, known.scene.cameras[0], known.media, options);
  }
};

}  // namespace sfumato::pipelines
