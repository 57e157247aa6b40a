// Frames of smoke in bricks against frames of the same smoke in a box.
#include <fmt/format.h>

#include <cmath>

#include "image/metrics.h"
#include "pipelines/linked_lists_gpu.h"
#include "tests/gl/test_device.h"
#include "tests/pipelines/known_scenes.h"
#include "tests/volumes/sparse_grids.h"

namespace sfumato::pipelines {
namespace {

using tests::KnownScene;

constexpr Quality quality{.samples = 1, .shadowResolution = 128, .stepVoxels = 0.7};

class SparseSmokeGpu : public tests::GpuTest {
 protected:
  image::Image draw(const KnownScene& known) {
    LinkedListsPipeline pipeline(device(), known.scene, known.media);
    return pipeline.render(known.scene.cameras[0], 64, 48, quality).radiance;
  }
};

// Largest difference over the mean of the second.
double largestDifference(const image::Image& a, const image::Image& b) {
  double largest = 0, sum = 0;
  for (size_t i = 0; i < a.values.size(); ++i) {
    largest = std::max(largest, static_cast<double>(std::abs(a.values[i] - b.values[i])));
    sum += b.values[i];
  }
  return largest * static_cast<double>(a.values.size()) / sum;
}

TEST_F(SparseSmokeGpu, DrawsBoxesAndBricksAlike) {
  for (const char* name : {"smoke and glass", "smoke over floor"}) {
    SCOPED_TRACE(name);
    KnownScene known = tests::named(tests::knownScenes(), name);
    const image::Image dense = draw(known);
    for (volumes::Medium& medium : known.media) medium.grid = tests::inBricks(medium.grid);
    const image::Image bricks = draw(known);
    EXPECT_LT(largestDifference(bricks, dense), 1e-3);
  }
}

// A cloud of two balls, far apart in a box of `size` voxels that begins at index `origin`.
volumes::DensityGrid twoBalls(const glm::ivec3& origin, const glm::ivec3& size, bool inBricks) {
  volumes::DensityGrid grid;
  grid.name = "density";
  grid.origin = origin;
  grid.size = size;
  if (inBricks)
    tests::addBrickMap(grid);
  else
    grid.values.assign(grid.valueIndex(0, 0, size.z), 0.f);
  for (const glm::ivec3& centre : {glm::ivec3(3000, 200, 60), glm::ivec3(3020, 210, 1500)})
    for (int z = -20; z <= 20; ++z)
      for (int y = -20; y <= 20; ++y)
        for (int x = -20; x <= 20; ++x) {
          const double density = 1 - std::sqrt(x * x + y * y + z * z) / 20;
          if (density <= 0) continue;
          const glm::ivec3 voxel = centre + glm::ivec3(x, y, z) - origin;
          if (inBricks)
            tests::setInBricks(grid, voxel, static_cast<float>(density));
          else
            grid.values[grid.valueIndex(voxel.x, voxel.y, voxel.z)] = static_cast<float>(density);
        }
  return grid;
}

// Seen and lit along z, a ray meets the box of both grids at the same places, whatever their width and
// height.
KnownScene cloudAlongZ(volumes::DensityGrid grid) {
  KnownScene known;
  volumes::Medium medium;
  medium.grid = std::move(grid);
  for (int axis = 0; axis < 3; ++axis) medium.worldFromIndex[axis][axis] = 0.01;
  medium.scale = 12;
  medium.albedo = {0.9, 0.6, 0.3};
  known.media.push_back(std::move(medium));
  known.scene.cameras.push_back(tests::orthographicCamera({30.1, 2.05, 30}, {30.1, 2.05, 0}, 0.4));
  known.scene.lights.push_back(tests::directionalLight({0, 0, -1}, {1, 2, 3}));
  tests::add(known.scene, tests::quad({29, 1, -0.2f}, {2.2f, 0, 0}, {0, 2.2f, 0}),
             tests::lambert({0.5f, 0.6f, 0.7f}));
  return known;
}

TEST_F(SparseSmokeGpu, AGridWiderThanTextureMayBeIsDrawnAsItsPart) {
  // 4096 x 300 x 1600: as a dense box 7.3 GiB, and wider than many a device allows.
  const image::Image wide = draw(cloudAlongZ(twoBalls({0, 0, 0}, {4096, 300, 1600}, true)));
  const image::Image part = draw(cloudAlongZ(twoBalls({2970, 170, 0}, {80, 70, 1600}, false)));
  const double difference = largestDifference(wide, part);
  fmt::print("largest difference over the mean: {:.2e}\n", difference);
  // Coordinates of 4096 voxels in single precision.
  EXPECT_LT(difference, 5e-3);
  EXPECT_GT(
      image::compare(part, draw(cloudAlongZ(twoBalls({2970, 170, 10}, {80, 70, 1590}, false)))).relativeRmse,
      0.0);  // a box that begins elsewhere is another march
}

}  // namespace
}  // namespace sfumato::pipelines
