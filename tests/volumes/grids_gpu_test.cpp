// Grids as shaders sample them, dense and in bricks, against double precision on the CPU.
#include "volumes/grids_gpu.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "base/error.h"
#include "base/random.h"
#include "gl/commands.h"
#include "tests/gl/test_device.h"
#include "tests/volumes/sparse_grids.h"
#include "volumes/reference_march.h"

namespace sfumato::volumes {
namespace {

using glm::dvec3;
using glm::ivec3;

struct Probe {
  glm::vec4 point;
  glm::vec4 direction;
};

// Points close to the borders of bricks, on them, and anywhere; directions with zeros among them.
std::vector<Probe> probesOf(const DensityGrid& grid, int side, int count) {
  base::Random random(11);
  std::vector<Probe> probes(static_cast<size_t>(count));
  const auto component = [&](int last) {
    const double anywhere = random.uniform(0, last);
    const double border = side * std::floor(random.uniform(0, last / side + 1));
    const double away[] = {0, 1e-4, -1e-4, random.uniform(-1, 1)};
    const double close = border + away[static_cast<int>(random.uniform(0, 4))];
    return std::clamp(random.uniform() < 0.3 ? anywhere : close, 0.0, static_cast<double>(last));
  };
  for (Probe& probe : probes) {
    probe = {};
    for (int axis = 0; axis < 3; ++axis) {
      probe.point[axis] = static_cast<float>(grid.origin[axis] + component(grid.size[axis] - 1));
      probe.direction[axis] = random.uniform() < 0.2 ? 0.f : static_cast<float>(random.uniform(-1, 1));
    }
    if (glm::length(probe.direction) == 0) probe.direction.x = 1;
  }
  return probes;
}

class GridsGpuTest : public tests::GpuTest {
 protected:
  // For each probe the value, and how far nothing comes.
  std::vector<glm::vec2> ask(const DensityGrid& grid, const std::vector<Probe>& probes,
                             const GridOptions& options, const std::string& inBricks) {
    const PlacedGrid placed{grid};
    const GridsGpu grids(device(), std::span(&placed, 1), options);
    EXPECT_EQ(grids.defines()[1].second, inBricks);
    const gl::Buffer questions(device(), "probes", std::span<const Probe>(probes));
    gl::Buffer answers(device(), "answers", probes.size() * sizeof(glm::vec2));
    grids.bind();
    questions.bindStorage(0);
    answers.bindStorage(1);
    gl::dispatchLinear(device().program({"volumes/sample_grid.comp"}, grids.defines()), probes.size());
    gl::storageBarrier();
    return answers.readValues<glm::vec2>(probes.size());
  }

  // Filtering of real GPUs weighs in steps of 1/256; values differ by up to 1 from voxel to voxel. Else it is
  // the rounding of coordinates.
  double tolerance() { return device().names().software ? 1e-4 : 3.0 / 256; }
};

double oracleAt(const DensityGrid& grid, const Probe& probe, double t = 0) {
  return densityAt(grid, dvec3(probe.point) + t * dvec3(probe.direction));
}

constexpr GridOptions bricksOf8{.textureSide = 82};  // below the longest side of what is drawn

TEST_F(GridsGpuTest, SampleTheSameDenseAndInBricks) {
  for (const bool half : {false, true}) {
    DensityGrid grid = tests::scatteredVoxels({83, 50, 67}, 40000, 5);
    grid.origin = {-40, 7, 1000};
    grid.half = half;
    const std::vector<Probe> probes = probesOf(grid, 8, 20000);
    const auto dense = ask(grid, probes, {}, "0");
    const auto bricks = ask(grid, probes, bricksOf8, "1");
    const auto sparse = ask(tests::inBricks(grid), probes, {}, "1");
    double worstDense = 0, worstBricks = 0, sum = 0;
    for (size_t i = 0; i < probes.size(); ++i) {
      const double expected = oracleAt(grid, probes[i]);
      sum += expected;
      worstDense = std::max(worstDense, std::abs(dense[i].x - expected));
      worstBricks = std::max(worstBricks, std::abs(bricks[i].x - expected));
      EXPECT_EQ(bricks[i], sparse[i]);
    }
    EXPECT_LT(worstDense, tolerance());
    EXPECT_LT(worstBricks, tolerance());
    EXPECT_GT(sum / static_cast<double>(probes.size()), 0.02);  // there was something to see
  }
}

TEST_F(GridsGpuTest, SampleLargerBricksWhereTheMapWouldBeTooLarge) {
  // One brick of 16 cells and its 17th voxel are all that fits the texture.
  DensityGrid grid = tests::scatteredVoxels({300, 20, 20}, 0, 5);
  base::Random random(2);
  for (int z = 1; z < 15; ++z)
    for (int y = 1; y < 15; ++y)
      for (int x = 161; x < 175; ++x)
        grid.values[grid.valueIndex(x, y, z)] = static_cast<float>(std::floor(random.uniform(0, 256))) / 256;
  const PlacedGrid placed{grid};
  EXPECT_EQ(GridsGpu(device(), std::span(&placed, 1), {.textureSide = 21}).defines()[2].second, "16");
  std::vector<Probe> probes = probesOf(grid, 16, 20000);
  for (Probe& probe : probes) probe.point.x = 158 + std::fmod(probe.point.x, 20.f);
  const auto bricks = ask(grid, probes, {.textureSide = 21}, "1");
  double worst = 0;
  for (size_t i = 0; i < probes.size(); ++i)
    worst = std::max(worst, std::abs(bricks[i].x - oracleAt(grid, probes[i])));
  EXPECT_LT(worst, tolerance());
}

TEST_F(GridsGpuTest, NothingComesAsFarAsTheySay) {
  DensityGrid grid = tests::scatteredVoxels({120, 90, 100}, 0, 9);
  for (const ivec3& low : {ivec3(1, 1, 1), ivec3(40, 64, 8), ivec3(100, 40, 70), ivec3(56, 24, 48)})
    for (int z = 0; z < 16; ++z)
      for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) grid.values[grid.valueIndex(low.x + x, low.y + y, low.z + z)] = 1;
  const std::vector<Probe> probes = probesOf(grid, 8, 5000);
  for (const GridOptions& options : {GridOptions{}, GridOptions{.textureSide = 100}}) {
    const auto answers = ask(grid, probes, options, options.textureSide == 100 ? "1" : "0");
    size_t jumps = 0, seenSoonAfter = 0;
    double worst = 0;
    for (size_t i = 0; i < probes.size(); ++i) {
      const double until = answers[i].y;
      EXPECT_GE(until, 0);
      if (until == 0) continue;
      ++jumps;
      constexpr int looks = 64;
      bool seenBeyond = false;
      for (int look = 0; look <= looks; ++look) {
        const double t = std::min(until, 400.0) * look / looks;
        worst = std::max(worst, oracleAt(grid, probes[i], t));
        seenBeyond = seenBeyond || oracleAt(grid, probes[i], until + 24.0 * look / looks) > 0;
      }
      if (seenBeyond) ++seenSoonAfter;
    }
    EXPECT_LT(worst, 1e-4);  // a brick's outermost voxels are 0, and so is what rounding sees behind them
    EXPECT_GT(jumps, probes.size() / 2);
    EXPECT_GT(seenSoonAfter, probes.size() / 50);  // jumps that were longer would have been noticed
  }
}

TEST_F(GridsGpuTest, TakeBricksWhereTheBudgetIsTooSmallForABox) {
  const DensityGrid grid = tests::scatteredVoxels({120, 90, 100}, 12, 9);
  const PlacedGrid placed{grid};
  const size_t before = device().memory().bytes();
  const GridsGpu dense(device(), std::span(&placed, 1), {});
  const size_t denseBytes = device().memory().bytes() - before;
  EXPECT_EQ(dense.defines()[1].second, "0");
  const GridsGpu bricks(device(), std::span(&placed, 1), {.budgetBytes = 1 << 20});
  const size_t brickBytes = device().memory().bytes() - before - denseBytes;
  EXPECT_EQ(bricks.defines()[1].second, "1");
  EXPECT_GE(denseBytes, grid.values.size() * 2);
  EXPECT_LT(brickBytes, size_t{1} << 20);
  EXPECT_LT(brickBytes, denseBytes / 4);
}

std::string memoryError(gl::Device& device, const DensityGrid& grid, const GridOptions& options) {
  const PlacedGrid placed{grid};
  try {
    const GridsGpu grids(device, std::span(&placed, 1), options);
  } catch (const base::Error& error) {
    EXPECT_EQ(error.exitCode, base::ExitCode::Memory);
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return "";
}

TEST_F(GridsGpuTest, SayHowMuchTheyTakeWhereThatIsTooMuch) {
  const DensityGrid grid = tests::scatteredVoxels({120, 90, 100}, 4000, 9);
  EXPECT_NE(memoryError(device(), grid, {.budgetBytes = 1 << 16}).find("the budget is 0.1 MiB"),
            std::string::npos);
  const std::string line = memoryError(device(), grid, {.textureSide = 60});
  EXPECT_NE(line.find("this device allows 60 a side"), std::string::npos) << line;
}

TEST_F(GridsGpuTest, AWideEmptyGridTakesLittle) {
  DensityGrid grid;
  grid.name = "wide";
  grid.size = {4096, 300, 4096};
  tests::addBrickMap(grid);
  grid.bricks.map[grid.brickIndex({4080, 200, 4070})] = 1;
  grid.bricks.values.assign(DensityGrid::valuesInBrick, 0.5f);
  const size_t before = device().memory().bytes();
  const PlacedGrid placed{grid};
  const GridsGpu grids(device(), std::span(&placed, 1), {});
  EXPECT_LT(device().memory().bytes() - before, size_t{65} << 20);
  std::vector<Probe> probes = probesOf(grid, 8, 1000);
  for (size_t i = 0; i < probes.size(); i += 2)
    probes[i].point = {4078 + 0.01f * static_cast<float>(i), 199.25f + 0.005f * static_cast<float>(i),
                       4073.5f, 0};
  const auto answers = ask(grid, probes, {}, "1");
  double worst = 0;
  for (size_t i = 0; i < probes.size(); ++i)
    worst = std::max(worst, std::abs(answers[i].x - oracleAt(grid, probes[i])));
  // Coordinates in single precision, of a grid of 4096 voxels.
  EXPECT_LT(worst, std::max(tolerance(), 2e-3));
}

}  // namespace
}  // namespace sfumato::volumes
