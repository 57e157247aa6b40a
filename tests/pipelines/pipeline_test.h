// Known scenes drawn by pipelines of a name, and held against what the core pipeline draws.
#pragma once

#include <string>

#include "image/metrics.h"
#include "pipelines/pipeline_gpu.h"
#include "tests/gl/test_device.h"
#include "tests/pipelines/frame_errors.h"
#include "tests/pipelines/known_scenes.h"

namespace sfumato::pipelines {

// What pipelines share need not be fine to be the same.
inline Quality coarse() {
  Quality quality = fine;
  quality.shadowResolution = 128;
  quality.stepVoxels = 2;
  quality.deferred.shadows = ShadowKind::Deep;
  return quality;
}

constexpr double rounding = 1e-5;  // of sums that are added up in another order, relative RMSE

class PipelineTest : public tests::GpuTest {
 protected:
  image::Image draw(const std::string& name, const tests::KnownScene& known, const Quality& quality,
                    glm::ivec2 size = {72, 54}) {
    return makePipeline(name, device(), known.scene, known.media)
        ->render(known.scene.cameras[0], size.x, size.y, quality)
        .radiance;
  }

  // The same surfaces, lights and steps as in the core pipeline.
  void expectListsPicture(const std::string& name, const tests::KnownScene& known, const Quality& quality,
                          glm::ivec2 size = {72, 54}) {
    const image::Image image = draw(name, known, quality, size);
    const image::Image lists = draw("lund", known, quality, size);
    keep(name + "_" + known.name, image);
    EXPECT_LT(image::compare(image, lists).relativeRmse, rounding);
    EXPECT_EQ(image::pixelsBeyond(image, lists, 1e-4), 0u);
  }
};

}  // namespace sfumato::pipelines
