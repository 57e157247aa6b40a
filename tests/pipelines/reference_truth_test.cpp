// The reference against pictures of another renderer: the folder that SFUMATO_TRUTH names holds NAME.gltf,
// the .vdb files that they name, and NAME.exr.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "image/image_file.h"
#include "image/metrics.h"
#include "pipelines/reference.h"
#include "scene/gltf.h"
#include "volumes/vdb_file.h"

namespace sfumato::pipelines {
namespace {

std::vector<volumes::Medium> readMedia(const scene::Scene& scene) {
  std::vector<volumes::Medium> media;
  for (const scene::VolumePlacement& volume : scene.volumes) {
    volumes::Medium medium;
    medium.grid = volumes::readVdb(volume.file, volume.gridName);
    medium.worldFromIndex = volume.worldFromGridWorld * medium.grid.worldFromIndex;
    medium.scale = volume.scale;
    medium.albedo = volume.albedo;
    medium.g = volume.g;
    media.push_back(std::move(medium));
  }
  return media;
}

class ReferenceTruth : public testing::TestWithParam<const char*> {};

TEST_P(ReferenceTruth, AgreesWithAnotherRenderer) {
  const char* folder = std::getenv("SFUMATO_TRUTH");
  if (folder == nullptr) GTEST_SKIP() << "SFUMATO_TRUTH names no folder of scenes with an outside answer";
  const std::filesystem::path base = std::filesystem::path(folder) / GetParam();
  const scene::Scene scene = scene::readGltf(base.string() + ".gltf");
  const image::Image truth = image::readImage(base.string() + ".exr");
  const image::Image image = renderReference(scene, scene.cameras[0], readMedia(scene),
                                             {.width = truth.width,
                                              .height = truth.height,
                                              .samples = 8,
                                              .stepVoxels = 1,
                                              .shadowStepVoxels = 1,
                                              .showProgress = true});
  const image::Difference difference = image::compare(image, truth);
  fmt::print("{}: relative RMSE {:.4f}, mean ratio {:.4f}, maximum {:.4f}\n", GetParam(),
             difference.relativeRmse, difference.meanRatio, difference.maximum);
  if (const char* output = std::getenv("SFUMATO_TRUTH_OUTPUT")) {
    const std::filesystem::path name = std::filesystem::path(output) / (std::string(GetParam()) + ".exr");
    image::writeImage(name, image, {}, true);
  }
  // The truth's own noise is below 1 %. An even number of samples, since edges that run along the middle of a
  // row, as the sun's horizon does, are all inside or all outside at the centre of a pixel.
  EXPECT_LT(difference.relativeRmse, 0.015);
  EXPECT_NEAR(difference.meanRatio, 1, 0.005);
}

INSTANTIATE_TEST_SUITE_P(Scenes, ReferenceTruth, testing::Values("two_lights", "sun"));

}  // namespace
}  // namespace sfumato::pipelines
