#include "volumes/vdb_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <numeric>
#include <set>

#include "base/error.h"
#include "base/file.h"
#include "base/random.h"
#include "tests/base/temporary_folder.h"
#include "volumes/procedural_smoke.h"

#ifdef SFUMATO_OPENVDB
#include <openvdb/openvdb.h>
#include <openvdb/tools/LevelSetSphere.h>
#endif

#ifdef __SANITIZE_ADDRESS__
// OpenVDB does not free the nodes read so far when a block cannot be decompressed.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:readTopology";
}
#endif

namespace sfumato::volumes {
namespace {

namespace fs = std::filesystem;
using base::ExitCode;

class VdbFile : public testing::Test {
 protected:
  fs::path path(const std::string& name) const { return folder_.path() / name; }

  // The one line of the error that `act` throws, with the folder cut away.
  std::string errorOf(ExitCode code, const std::function<void()>& act) const {
    try {
      act();
    } catch (const base::Error& error) {
      EXPECT_EQ(error.exitCode, code) << error.what();
      std::string line = error.what();
      EXPECT_EQ(line.find('\n'), std::string::npos) << line;
      const std::string prefix = folder_.path().string() + "/";
      if (line.starts_with(prefix)) line = line.substr(prefix.size());
      return line;
    }
    ADD_FAILURE() << "no error";
    return {};
  }

 private:
  const test::TemporaryFolder folder_{"vdb"};
};

#ifdef SFUMATO_OPENVDB

openvdb::FloatGrid::Ptr fogGrid(const std::string& name) {
  openvdb::initialize();
  auto grid = openvdb::FloatGrid::create(0.f);
  grid->setName(name);
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  return grid;
}

void save(const fs::path& path, const openvdb::GridPtrVec& grids) {
  openvdb::io::File(path.string()).write(grids);
}

openvdb::FloatGrid::Ptr readWithOpenVdb(const fs::path& path) {
  openvdb::initialize();
  openvdb::io::File file(path.string());
  file.open(false);
  return openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid("density"));
}

// A small cloud over several leaves and both signs of coordinates.
openvdb::FloatGrid::Ptr smallCloud(const std::string& name = "density") {
  auto grid = fogGrid(name);
  auto accessor = grid->getAccessor();
  for (int z = -9; z < 9; ++z)
    for (int y = 0; y < 12; ++y)
      for (int x = -3; x < 10; ++x)
        if ((x * 7 + y * 5 + z * 3) % 4 != 0)
          accessor.setValue({x, y, z}, 0.25f + 0.01f * static_cast<float>(x + 2 * y + 4 * (z + 9)));
  return grid;
}

float valueAt(const DensityGrid& grid, int i, int j, int k) {
  const glm::ivec3 p = glm::ivec3(i, j, k) - grid.origin;
  if (p.x < 0 || p.y < 0 || p.z < 0 || p.x >= grid.size.x || p.y >= grid.size.y || p.z >= grid.size.z)
    return 0;
  return grid.value(p);
}

// Every voxel of `grid`, and one voxel beyond, is what OpenVDB says.
void expectSameValues(const DensityGrid& grid, const openvdb::FloatGrid& oracle) {
  auto accessor = oracle.getConstAccessor();
  long wrong = 0;
  for (int z = -1; z <= grid.size.z; ++z)
    for (int y = -1; y <= grid.size.y; ++y)
      for (int x = -1; x <= grid.size.x; ++x) {
        const glm::ivec3 p = grid.origin + glm::ivec3(x, y, z);
        float expected = 0;
        if (!accessor.probeValue({p.x, p.y, p.z}, expected)) expected = 0;
        wrong += valueAt(grid, p.x, p.y, p.z) != expected;
      }
  EXPECT_EQ(wrong, 0);
}

void expectWellFormed(const DensityGrid& grid) {
  ASSERT_EQ(grid.values.size(), static_cast<size_t>(grid.size.x) * static_cast<size_t>(grid.size.y) *
                                    static_cast<size_t>(grid.size.z));
  for (int z = 0; z < grid.size.z; ++z)
    for (int y = 0; y < grid.size.y; ++y)
      for (int x = 0; x < grid.size.x; ++x) {
        const float value = grid.values[grid.valueIndex(x, y, z)];
        const bool margin = x == 0 || y == 0 || z == 0 || x == grid.size.x - 1 || y == grid.size.y - 1 ||
                            z == grid.size.z - 1;
        ASSERT_TRUE(std::isfinite(value) && value >= 0 && (!margin || value == 0));
      }
}

TEST_F(VdbFile, IsReadOnceForAllItsGrids) {
  auto flames = fogGrid("flames");
  flames->tree().setValueOn({3, 4, 5}, 0.75f);
  save(path("fire.vdb"), {smallCloud(), flames});
  const DensityGrid density = readVdb(path("fire.vdb"), "density");
  const VdbReader reader(path("fire.vdb"));
  fs::remove(path("fire.vdb"));
  EXPECT_EQ(reader.read("density").values, density.values);
  EXPECT_EQ(valueAt(reader.read("flames"), 3, 4, 5), 0.75f);
  EXPECT_EQ(reader.read("").values, density.values);
}

TEST_F(VdbFile, KeepsValuesNamePlaceAndTransformThroughWritingAndReading) {
  DensityGrid grid;
  grid.name = "steam";
  grid.origin = {-7, 3, 100};
  grid.size = {5, 4, 6};
  grid.values.assign(5 * 4 * 6, 0.f);
  for (int z = 1; z < 5; ++z)
    for (int y = 1; y < 3; ++y)
      for (int x = 1; x < 4; ++x) grid.values[grid.valueIndex(x, y, z)] = 1.f / static_cast<float>(x + y + z);
  grid.worldFromIndex =
      glm::dmat4({0.1, 0.02, -0.3, 0}, {0.05, 0.4, 0.01, 0}, {-0.2, 0.03, 0.25, 0}, {5, -6, 7, 1});
  writeVdb(path("steam.vdb"), grid);

  const DensityGrid read = readVdb(path("steam.vdb"), "");
  EXPECT_EQ(read.name, "steam");
  EXPECT_EQ(read.origin, grid.origin);
  EXPECT_EQ(read.size, grid.size);
  EXPECT_EQ(read.values, grid.values);
  EXPECT_EQ(read.worldFromIndex, grid.worldFromIndex);
}

TEST_F(VdbFile, SaysWithWhichOptionToChooseAnother) {
  save(path("a.vdb"), {fogGrid("heat")});
  EXPECT_EQ(errorOf(ExitCode::Input, [&] { readVdb(path("a.vdb"), "flame", usualVdbBytes, "--fire"); }),
            "a.vdb: no float grid \"flame\" (has: heat (float)): choose one with --fire NAME");
}

TEST_F(VdbFile, WritesSeveralGridsIntoOneFile) {
  const FlameGrids flame = makeFlame(16, 1, 1);
  const DensityGrid* grids[] = {&flame.smoke, &flame.temperature};
  writeVdb(path("fire.vdb"), grids);
  EXPECT_EQ(readVdb(path("fire.vdb"), "").name, "density");
  const DensityGrid read = readVdb(path("fire.vdb"), "temperature");
  EXPECT_EQ(read.worldFromIndex, flame.temperature.worldFromIndex);
  const auto sum = [](const DensityGrid& grid) {
    return std::accumulate(grid.values.begin(), grid.values.end(), 0.0);
  };
  EXPECT_GT(sum(read), 0);
  EXPECT_EQ(sum(read), sum(flame.temperature));
}

TEST_F(VdbFile, WritesAFogVolumeThatOpenVdbReads) {
  DensityGrid grid;
  grid.name = "density";
  grid.origin = {10, 20, 30};
  grid.size = {3, 3, 4};
  grid.values.assign(3 * 3 * 4, 0.f);
  grid.values[grid.valueIndex(1, 1, 1)] = 0.5f;
  grid.values[grid.valueIndex(1, 1, 2)] = 0.75f;
  grid.worldFromIndex[0] = {0, 0, -2, 0};  // a quarter turn about y, doubled
  grid.worldFromIndex[2] = {2, 0, 0, 0};
  writeVdb(path("a.vdb"), grid);

  const auto read = readWithOpenVdb(path("a.vdb"));
  EXPECT_EQ(read->getGridClass(), openvdb::GRID_FOG_VOLUME);
  EXPECT_EQ(read->activeVoxelCount(), 2u);
  EXPECT_EQ(read->getConstAccessor().getValue({11, 21, 32}), 0.75f);
  EXPECT_EQ(read->indexToWorld(openvdb::Vec3d(1, 0, 0)), openvdb::Vec3d(0, 0, -2));
}

TEST_F(VdbFile, LeavesNothingBehindWhenItCannotWrite) {
  DensityGrid grid;
  grid.size = {1, 1, 1};
  grid.values = {1.f};
  errorOf(ExitCode::Input, [&] { writeVdb(path("no/such/folder/a.vdb"), grid); });
  fs::create_directory(path("folder.vdb"));
  errorOf(ExitCode::Input, [&] { writeVdb(path("folder.vdb"), grid); });
  EXPECT_EQ(std::distance(fs::directory_iterator(path("")), {}), 1);
}

TEST_F(VdbFile, ReadsEveryVoxelWithAMarginOfOne) {
  const auto cloud = smallCloud();
  save(path("a.vdb"), {cloud});
  const DensityGrid grid = readVdb(path("a.vdb"), "density");
  EXPECT_EQ(grid.origin, glm::ivec3(-4, -1, -10));
  EXPECT_EQ(grid.size, glm::ivec3(15, 14, 20));
  expectWellFormed(grid);
  expectSameValues(grid, *cloud);
}

TEST_F(VdbFile, ReadsUncompressedAndZippedFiles) {
  const auto cloud = smallCloud();
  for (const uint32_t flags : {0u, 1u, 2u, 3u, 4u}) {
    openvdb::io::File file(path("a.vdb").string());
    file.setCompression(flags);
    file.write(openvdb::GridPtrVec{cloud});
    SCOPED_TRACE(flags);
    expectSameValues(readVdb(path("a.vdb"), ""), *cloud);
  }
}

TEST_F(VdbFile, ReadsHalfFloats) {
  const auto cloud = smallCloud();
  cloud->setSaveFloatAsHalf(true);
  save(path("a.vdb"), {cloud});
  expectSameValues(readVdb(path("a.vdb"), ""), *readWithOpenVdb(path("a.vdb")));
}

TEST_F(VdbFile, ReadsActiveTilesAndSkipsInactiveOnes) {
  const auto grid = fogGrid("density");
  grid->sparseFill(openvdb::CoordBBox({-8, 0, 16}, {23, 7, 31}), 0.5f, true);
  grid->sparseFill(openvdb::CoordBBox({64, 64, 64}, {71, 71, 71}), 9.f, false);
  ASSERT_GT(grid->tree().activeTileCount(), 0u);
  save(path("a.vdb"), {grid});
  const DensityGrid read = readVdb(path("a.vdb"), "");
  EXPECT_EQ(read.size, glm::ivec3(34, 10, 18));
  expectWellFormed(read);
  expectSameValues(read, *grid);
}

TEST_F(VdbFile, TrimsActiveZeros) {
  const auto grid = fogGrid("density");
  grid->fill(openvdb::CoordBBox({0, 0, 0}, {200, 200, 200}), 0.f, true);
  grid->getAccessor().setValue({50, 60, 70}, 1.f);
  save(path("a.vdb"), {grid});
  const DensityGrid read = readVdb(path("a.vdb"), "");
  EXPECT_EQ(read.origin, glm::ivec3(49, 59, 69));
  EXPECT_EQ(read.size, glm::ivec3(3, 3, 3));
  EXPECT_EQ(read.values[13], 1.f);
}

TEST_F(VdbFile, TakesEveryLinearTransformAsOpenVdbDoes) {
  using openvdb::math::Transform;
  openvdb::initialize();
  const auto rotatedAndSheared = Transform::createLinearTransform(0.5);
  rotatedAndSheared->postRotate(0.7, openvdb::math::X_AXIS);
  rotatedAndSheared->postRotate(-0.4, openvdb::math::Z_AXIS);
  rotatedAndSheared->postShear(0.3, openvdb::math::Y_AXIS, openvdb::math::X_AXIS);
  rotatedAndSheared->postTranslate({1, -2, 3});
  const auto scaled = Transform::createLinearTransform(1.0);
  scaled->postScale(openvdb::Vec3d(0.1, 0.2, 0.3));
  const auto scaledAndMoved = scaled->copy();
  scaledAndMoved->postTranslate({7, 8, 9});
  const auto uniformAndMoved = Transform::createLinearTransform(0.25);
  uniformAndMoved->postTranslate({7, 8, 9});

  std::set<std::string> kinds;
  for (const auto& transform :
       {rotatedAndSheared, scaled, scaledAndMoved, uniformAndMoved, Transform::createLinearTransform(0.1)}) {
    const auto grid = smallCloud();
    grid->setTransform(transform);
    kinds.insert(transform->mapType());
    SCOPED_TRACE(transform->mapType());
    save(path("a.vdb"), {grid});
    const DensityGrid read = readVdb(path("a.vdb"), "");
    for (const auto& p : {openvdb::Vec3d(0, 0, 0), openvdb::Vec3d(3, -5, 11), openvdb::Vec3d(-100, 20, 7)}) {
      const openvdb::Vec3d expected = transform->indexToWorld(p);
      const glm::dvec4 world = read.worldFromIndex * glm::dvec4(p.x(), p.y(), p.z(), 1);
      EXPECT_NEAR(world.x, expected.x(), 1e-12);
      EXPECT_NEAR(world.y, expected.y(), 1e-12);
      EXPECT_NEAR(world.z, expected.z(), 1e-12);
    }
  }
  EXPECT_EQ(kinds, (std::set<std::string>{"AffineMap", "ScaleMap", "ScaleTranslateMap", "UniformScaleMap",
                                          "UniformScaleTranslateMap"}));
}

std::string sizedString(const std::string& text) {
  const auto size = static_cast<uint32_t>(text.size());
  return std::string(reinterpret_cast<const char*>(&size), sizeof(size)) + text;
}

// OpenVDB can read these two, but no longer writes them.
TEST_F(VdbFile, TakesTheTransformsOfOlderFiles) {
  const auto rewritten = [&](const std::string& from, size_t bytes, const std::string& to) {
    std::ifstream file(path("a.vdb"), std::ios::binary);
    std::string text(std::istreambuf_iterator<char>(file), {});
    text.replace(text.find(sizedString(from)), sizedString(from).size() + bytes, to);
    text.resize(std::max<size_t>(text.size(), fs::file_size(path("a.vdb"))));
    std::ofstream(path("b.vdb"), std::ios::binary) << text;
    return readVdb(path("b.vdb"), "").worldFromIndex;
  };
  const auto cloud = smallCloud();
  cloud->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
  save(path("a.vdb"), {cloud});
  const double offset[3] = {-4, 5, 6};
  const std::string offsetBytes(reinterpret_cast<const char*>(offset), sizeof(offset));
  EXPECT_EQ(rewritten("UniformScaleMap", 15 * sizeof(double), sizedString("TranslationMap") + offsetBytes),
            glm::dmat4({1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {-4, 5, 6, 1}));

  cloud->transform().postRotate(std::atan2(3, 4), openvdb::math::Z_AXIS);
  save(path("a.vdb"), {cloud});
  const glm::dmat4 turned = rewritten("AffineMap", 0, sizedString("UnitaryMap"));
  EXPECT_NEAR(turned[0][0], 0.4, 1e-15);
  EXPECT_NEAR(turned[0][1], 0.3, 1e-15);
  EXPECT_NEAR(turned[1][0], -0.3, 1e-15);
}

TEST_F(VdbFile, ChoosesDensityElseTheOnlyFloatGrid) {
  const auto heat = smallCloud("heat");
  const auto velocity = openvdb::Vec3SGrid::create();
  velocity->setName("vel");
  save(path("one.vdb"), {velocity, heat});
  EXPECT_EQ(readVdb(path("one.vdb"), "").name, "heat");
  save(path("two.vdb"), {velocity, heat, smallCloud("density")});
  EXPECT_EQ(readVdb(path("two.vdb"), "").name, "density");
  EXPECT_EQ(readVdb(path("two.vdb"), "heat").name, "heat");
}

TEST_F(VdbFile, ListsTheGridsWhenThereIsNoneToTake) {
  const auto velocity = openvdb::Vec3SGrid::create();
  velocity->setName("vel");
  save(path("a.vdb"), {smallCloud("heat"), velocity, smallCloud("fuel")});
  EXPECT_EQ(
      errorOf(ExitCode::Input, [&] { readVdb(path("a.vdb"), ""); }),
      "a.vdb: no float grid \"density\" (has: heat (float), vel (vec3s), fuel (float)): choose one with "
      "--grid NAME");
  EXPECT_EQ(errorOf(ExitCode::Input, [&] { readVdb(path("a.vdb"), "vel"); }),
            "a.vdb: no float grid \"vel\" (has: heat (float), vel (vec3s), fuel (float)): choose one with "
            "--grid NAME");
  save(path("b.vdb"), {velocity});
  EXPECT_EQ(errorOf(ExitCode::Input, [&] { readVdb(path("b.vdb"), ""); }),
            "b.vdb: no float grid \"density\" (has: vel (vec3s)): export one of floats");
  save(path("c.vdb"), {});
  EXPECT_EQ(errorOf(ExitCode::Input, [&] { readVdb(path("c.vdb"), ""); }),
            "c.vdb: no float grid \"density\" (has: no grid at all): export one of floats");
}

TEST_F(VdbFile, AsksWhichOneWhenNamesAreDouble) {
  const auto second = smallCloud();
  second->getAccessor().setValue({0, 0, 0}, 42.f);
  save(path("a.vdb"), {smallCloud(), second});
  EXPECT_EQ(errorOf(ExitCode::Input, [&] { readVdb(path("a.vdb"), ""); }),
            "a.vdb: 2 grids are called \"density\": choose one with --grid \"density[0]\"");
  const float first = valueAt(readVdb(path("a.vdb"), "density[0]"), 0, 0, 0);
  EXPECT_NE(first, valueAt(readVdb(path("a.vdb"), "density[1]"), 0, 0, 0));
}

TEST_F(VdbFile, ReadsAGridThatSharesItsTree) {
  const auto owner = smallCloud("a");
  const auto sharer = openvdb::FloatGrid::create(owner->treePtr());
  sharer->setName("b");
  sharer->setTransform(openvdb::math::Transform::createLinearTransform(0.125));
  save(path("a.vdb"), {owner, sharer});
  const DensityGrid read = readVdb(path("a.vdb"), "b");
  expectSameValues(read, *owner);
  EXPECT_EQ(read.worldFromIndex[0][0], 0.125);
}

TEST_F(VdbFile, DoesNotMindTypesItDoesNotKnow) {
  save(path("a.vdb"), {smallCloud("density"), smallCloud("other")});
  std::vector<std::byte> bytes = base::readFile(path("a.vdb"));
  std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const size_t type = text.rfind("Tree_float_5_4_3");
  text.replace(type, 16, "Tree_alien_5_4_3");
  std::ofstream(path("b.vdb"), std::ios::binary) << text;
  EXPECT_EQ(readVdb(path("b.vdb"), "density").name, "density");
}

TEST_F(VdbFile, RefusesWhatIsNoFogVolume) {
  openvdb::initialize();
  const auto sphere = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(2.f, {0, 0, 0}, 0.5f);
  sphere->setName("surface");
  save(path("a.vdb"), {sphere});
  EXPECT_EQ(errorOf(ExitCode::Input, [&] { readVdb(path("a.vdb"), ""); }),
            "a.vdb: grid \"surface\" is a level set, which has distances, not densities: convert it to a fog "
            "volume");

  const auto endless = openvdb::FloatGrid::create(0.5f);
  endless->setName("density");
  endless->getAccessor().setValue({0, 0, 0}, 1.f);
  save(path("b.vdb"), {endless});
  EXPECT_EQ(errorOf(ExitCode::Input, [&] { readVdb(path("b.vdb"), ""); }),
            "b.vdb: grid \"density\" has the background 0.5, so it has no end: give a fog volume of "
            "background 0");

  const auto frustum = smallCloud();
  frustum->setTransform(openvdb::math::Transform::createFrustumTransform(
      openvdb::BBoxd({0, 0, 0}, {10, 10, 10}), 0.5, 10.0, 1.0));
  save(path("c.vdb"), {frustum});
  EXPECT_EQ(errorOf(ExitCode::Input, [&] { readVdb(path("c.vdb"), ""); }),
            "c.vdb: grid \"density\" has a frustum transform, which is not linear: resample it to a box of "
            "equal voxels");
}

TEST_F(VdbFile, RefusesValuesThatAreNoDensity) {
  for (const auto& [value, text] : {std::pair{-1.f, "-1"}, {std::nanf(""), "nan"}, {HUGE_VALF, "inf"}}) {
    const auto grid = smallCloud();
    grid->getAccessor().setValue({4, 5, -6}, value);
    save(path("a.vdb"), {grid});
    EXPECT_EQ(errorOf(ExitCode::Input, [&] { readVdb(path("a.vdb"), ""); }),
              fmt::format("a.vdb: grid \"density\" has the density {} at voxel (4, 5, -6): give finite "
                          "densities of 0 or more",
                          text));
  }
}

TEST_F(VdbFile, RefusesAnEmptyGrid) {
  save(path("a.vdb"), {fogGrid("density")});
  EXPECT_EQ(errorOf(ExitCode::Input, [&] { readVdb(path("a.vdb"), ""); }),
            "a.vdb: grid \"density\" is empty: give one with an active density above 0");
}

TEST_F(VdbFile, ReadsWhatIsMostlyEmptyInBricks) {
  // As a box 16 GiB; voxels in all corners of leaves, tiles of both kinds, and a cloud.
  const auto grid = fogGrid("density");
  const auto cloud = smallCloud();
  grid->tree().merge(cloud->tree());
  auto accessor = grid->getAccessor();
  for (int i = 0; i < 500; ++i)
    accessor.setValue({-300 + (i * 757) % 4000, (i * 113) % 250, (i * 1499) % 4000},
                      0.5f + 0.001f * static_cast<float>(i));
  grid->sparseFill(openvdb::CoordBBox({1000, 0, 1600}, {1023, 15, 1615}), 0.5f, true);
  grid->sparseFill(openvdb::CoordBBox({2000, 64, 64}, {2015, 71, 71}), 9.f, false);
  save(path("a.vdb"), {grid});
  const DensityGrid read = readVdb(path("a.vdb"), "");
  ASSERT_FALSE(read.dense());
  EXPECT_LT(read.bytes(), size_t{64} << 20);
  size_t found = 0;
  forEachRow(read, [&](glm::ivec3 voxel, std::span<const float> row) {
    for (const float value : row) {
      const openvdb::Coord at(read.origin.x + voxel.x, read.origin.y + voxel.y, read.origin.z + voxel.z);
      float expected = 0;
      if (!accessor.probeValue(at, expected)) expected = 0;
      if (value != expected) ADD_FAILURE() << at << ": " << value << " for " << expected;
      found += value != 0;
      ++voxel.x;
    }
  });
  EXPECT_EQ(found, grid->activeVoxelCount());

  writeVdb(path("b.vdb"), read);
  const DensityGrid again = readVdb(path("b.vdb"), "");
  EXPECT_EQ(again.size, read.size);
  EXPECT_EQ(again.bricks.map.size(), read.bricks.map.size());
  EXPECT_EQ(again.bytes(), read.bytes());
  for (int i = 0; i < 500; ++i) {
    const glm::ivec3 voxel =
        glm::ivec3(-300 + (i * 757) % 4000, (i * 113) % 250, (i * 1499) % 4000) - read.origin;
    EXPECT_EQ(again.value(voxel), read.value(voxel));
  }
}

TEST_F(VdbFile, KeepsADenseBoxWhereBricksWouldSaveLittle) {
  const auto grid = fogGrid("density");
  grid->denseFill(openvdb::CoordBBox({0, 0, 0}, {299, 299, 299}), 0.25f, true);  // 104 MiB
  save(path("a.vdb"), {grid});
  const DensityGrid read = readVdb(path("a.vdb"), "");
  EXPECT_TRUE(read.dense());
  EXPECT_EQ(read.value({150, 150, 150}), 0.25f);
}

TEST_F(VdbFile, SaysWhereTheMapOfBricksIsTooLarge) {
  const auto thin = fogGrid("density");  // a row of voxels from end to end of what OpenVDB can hold
  thin->getAccessor().setValue({-1'000'000'000, 0, 0}, 1.f);
  thin->getAccessor().setValue({1'000'000'000, 0, 0}, 1.f);
  save(path("a.vdb"), {thin});
  const std::string line = errorOf(ExitCode::Memory, [&] { readVdb(path("a.vdb"), ""); });
  EXPECT_NE(line.find("2000000003 x 3 x 3 voxels"), std::string::npos) << line;

  const auto plane = fogGrid("density");
  plane->getAccessor().setValue({0, 0, 0}, 1.f);
  plane->getAccessor().setValue({200'000, 200'000, 0}, 1.f);  // 2.3 GiB of map
  save(path("b.vdb"), {plane});
  errorOf(ExitCode::Memory, [&] { readVdb(path("b.vdb"), ""); });
}

TEST_F(VdbFile, SaysHowMuchADenseBoxWouldTakeBeforeTakingIt) {
  const auto wide = fogGrid("density");
  wide->getAccessor().setValue({-1'000'000'000, 0, 0}, 1.f);
  wide->getAccessor().setValue({1'000'000'000, 1'000'000'000, 1'000'000'000}, 1.f);
  save(path("a.vdb"), {wide});
  const std::string line = errorOf(ExitCode::Memory, [&] { readVdb(path("a.vdb"), ""); });
  EXPECT_NE(line.find("2000000003 x 1000000003 x 1000000003 voxels"), std::string::npos) << line;

  const auto tile = fogGrid("density");
  tile->tree().addTile(3, {0, 0, 0}, 1.f, true);  // 4096^3 voxels in a few bytes
  save(path("b.vdb"), {tile});
  const std::string tileLine = errorOf(ExitCode::Memory, [&] { readVdb(path("b.vdb"), ""); });
  EXPECT_NE(tileLine.find("4098 x 4098 x 4098 voxels"), std::string::npos) << tileLine;

  // The box of the small cloud is 15 x 14 x 20: just enough, and one byte too little.
  const auto oneLeaf = fogGrid("density");
  oneLeaf->sparseFill(openvdb::CoordBBox({0, 0, 0}, {127, 127, 127}), 1.f, true);
  save(path("c.vdb"), {oneLeaf});
  const size_t exact = size_t{130} * 130 * 130 * sizeof(float);
  EXPECT_EQ(readVdb(path("c.vdb"), "", exact).size, glm::ivec3(130));
  errorOf(ExitCode::Memory, [&] { readVdb(path("c.vdb"), "", exact - 1); });
}

TEST_F(VdbFile, RefusesFilesThatAreNone) {
  EXPECT_TRUE(
      errorOf(ExitCode::Input, [&] { readVdb(path("missing.vdb"), ""); }).starts_with("missing.vdb: "));
  std::ofstream(path("empty.vdb")).close();
  EXPECT_EQ(errorOf(ExitCode::Input, [&] { readVdb(path("empty.vdb"), ""); }),
            "empty.vdb: is empty: copy or export it again");
  std::ofstream(path("text.vdb")) << "not a volume, by any means";
  EXPECT_EQ(errorOf(ExitCode::Input, [&] { readVdb(path("text.vdb"), ""); }),
            "text.vdb: is not an OpenVDB file: give a .vdb file");
}

// Any file may be refused, in a line, or read as a grid that holds what grid.h promises; never more.
void readDamaged(const fs::path& path) {
  try {
    expectWellFormed(readVdb(path, "", size_t{64} << 20));
  } catch (const base::Error& error) {
    EXPECT_TRUE(error.exitCode == ExitCode::Input || error.exitCode == ExitCode::Memory) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
}

class DamagedVdbFile : public VdbFile, public testing::WithParamInterface<uint32_t> {
 protected:
  // Two grids of which the second is read, by the compression under test.
  std::string smallFile() const {
    const auto cloud = smallCloud();
    cloud->sparseFill(openvdb::CoordBBox({128, 128, 128}, {135, 135, 135}), 0.5f, true);
    cloud->setSaveFloatAsHalf(GetParam() > 4);
    openvdb::io::File file(path("whole.vdb").string());
    file.setCompression(GetParam() & 7);
    file.write(openvdb::GridPtrVec{smallCloud("another"), cloud});
    const auto bytes = base::readFile(path("whole.vdb"));
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }

  void readAsFile(const std::string& content) const {
    std::ofstream(path("damaged.vdb"), std::ios::binary) << content;
    readDamaged(path("damaged.vdb"));
  }
};

TEST_P(DamagedVdbFile, IsRefusedWhereverItIsCut) {
  const std::string whole = smallFile();
  expectSameValues(readVdb(path("whole.vdb"), ""), *readWithOpenVdb(path("whole.vdb")));
  base::Random random(1);
  for (size_t length = 0; length < whole.size();
       length += 1 + random.next() % (length < 1500 ? 8 : whole.size() / 100)) {
    std::ofstream(path("cut.vdb"), std::ios::binary) << whole.substr(0, length);
    errorOf(ExitCode::Input, [&] { readVdb(path("cut.vdb"), "density"); });
  }
}

TEST_P(DamagedVdbFile, IsReadOrRefusedWithAnyByteChanged) {
  const std::string whole = smallFile();
  base::Random random(2);
  constexpr int changes = 200;
  for (int i = 0; i < changes; ++i) {
    std::string damaged = whole;
    // Half of the changes go to the names, sizes and masks at the beginning, the others anywhere.
    const size_t reach = i % 2 == 0 ? 2000 : whole.size();
    constexpr char telling[] = {'\0', '\x01', '\x7f', '\x80', '\xff'};
    for (uint32_t n = 1 + random.next() % 3; n > 0; --n)
      damaged[random.next() % reach] =
          i % 3 == 0 ? static_cast<char>(random.next()) : telling[random.next() % sizeof(telling)];
    readAsFile(damaged);
  }
}

TEST_P(DamagedVdbFile, IsReadOrRefusedWithABlockOfBytesFilled) {
  const std::string whole = smallFile();
  base::Random random(3);
  for (int i = 0; i < 100; ++i) {
    std::string damaged = whole;
    const size_t begin = random.next() % whole.size();
    const size_t count = std::min<size_t>(whole.size() - begin, 8 + random.next() % 1000);
    damaged.replace(begin, count, count, i % 2 == 0 ? '\xff' : '\0');
    readAsFile(damaged);
  }
}

INSTANTIATE_TEST_SUITE_P(, DamagedVdbFile, testing::Values(0u, 1u, 2u, 4u, 6u, 14u),
                         [](const auto& info) { return "Compression" + std::to_string(info.param); });

struct RealFile {
  const char* variable;  // of the environment, the folder it is in
  const char* name;
  long activeVoxels;
  glm::ivec3 low, high;
  float maximum;
  double voxel;
};

void PrintTo(const RealFile& file, std::ostream* out) {
  *out << file.name;
}

class RealVdbFile : public testing::TestWithParam<RealFile> {};

TEST_P(RealVdbFile, HasTheVoxelsThatItsOwnersState) {
  const RealFile& expected = GetParam();
  const char* folder = std::getenv(expected.variable);
  if (!folder) GTEST_SKIP() << expected.variable << " is not set: no " << expected.name;
  const fs::path file = fs::path(folder) / expected.name;
  const DensityGrid grid = readVdb(file, "");
  expectWellFormed(grid);
  EXPECT_EQ(grid.origin, expected.low - 1);
  EXPECT_EQ(grid.size, expected.high - expected.low + 3);
  long count = 0;
  float maximum = 0;
  for (const float value : grid.values) {
    count += value != 0;
    maximum = std::max(maximum, value);
  }
  EXPECT_EQ(count, expected.activeVoxels);
  EXPECT_NEAR(maximum, expected.maximum, 1e-5);
  EXPECT_NEAR(voxelSize(grid.worldFromIndex), expected.voxel, 1e-12);

  const auto truth = readWithOpenVdb(file);
  expectSameValues(grid, *truth);
  const openvdb::Vec3d corner = truth->indexToWorld(openvdb::Vec3d(expected.low.x, 2.5, 100));
  const glm::dvec4 world = grid.worldFromIndex * glm::dvec4(expected.low.x, 2.5, 100, 1);
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(world[axis], corner[axis], 1e-12);
}

INSTANTIATE_TEST_SUITE_P(
    , RealVdbFile,
    testing::Values(
        RealFile{
            "SFUMATO_DATA", "openvdb_smoke.vdb", 1'049'275, {1, 2, 1}, {111, 223, 112}, 5.71484f, 10.0 / 21},
        RealFile{"SFUMATO_DATA", "dragon.vdb", 19'660, {16, 1, 35}, {85, 49, 65}, 1.f, 0.1f},
        RealFile{"SFUMATO_TRUTH", "smoke.vdb", 995'320, {1, 0, 0}, {127, 255, 127}, 0.985059f, 0.015625}));

#else

TEST_F(VdbFile, SaysThatThisBuildHasNoOpenVdb) {
  EXPECT_EQ(errorOf(ExitCode::Input, [&] { readVdb(path("a.vdb"), ""); }),
            "a.vdb: cannot be read: this build has no OpenVDB");
  EXPECT_EQ(errorOf(ExitCode::Input, [&] { writeVdb(path("a.vdb"), DensityGrid{}); }),
            "a.vdb: cannot be written: this build has no OpenVDB");
}

#endif

}  // namespace
}  // namespace sfumato::volumes
