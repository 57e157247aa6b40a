// Writes a wide, mostly empty cloud, for figures: sparse_smoke FILE.vdb. 24 plumes in a box of 4096 x 300 x
// 4096 voxels.
#include <fmt/format.h>

#include "base/error.h"
#include "base/random.h"
#include "tests/volumes/sparse_grids.h"
#include "volumes/procedural_smoke.h"
#include "volumes/vdb_file.h"

namespace {

using sfumato::volumes::DensityGrid;

DensityGrid wideCloud() {
  constexpr int plumes = 24, voxelsHigh = 256;
  DensityGrid wide;
  wide.name = "density";
  wide.size = {4096, 300, 4096};
  sfumato::tests::addBrickMap(wide);
  sfumato::base::Random random(1);
  for (int i = 0; i < plumes; ++i) {
    const DensityGrid plume = sfumato::volumes::makePlume(voxelsHigh, 2, static_cast<uint64_t>(i % 3));
    wide.worldFromIndex = plume.worldFromIndex;
    glm::ivec3 corner;
    for (int axis = 0; axis < 3; ++axis)
      corner[axis] = 1 + static_cast<int>(random.uniform(0, wide.size[axis] - plume.size[axis] - 2));
    forEachRow(plume, [&](glm::ivec3 voxel, std::span<const float> row) {
      for (const float value : row) {
        if (value != 0) sfumato::tests::setInBricks(wide, corner + voxel, value);
        ++voxel.x;
      }
    });
  }
  return wide;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    fmt::print(stderr, "usage: sparse_smoke FILE.vdb\n");
    return 2;
  }
  try {
    sfumato::volumes::writeVdb(arguments[1], wideCloud());
  } catch (const sfumato::base::Error& error) {
    fmt::print(stderr, "sparse_smoke: error: {}\n", error.what());
    return static_cast<int>(error.exitCode);
  }
  return 0;
}
