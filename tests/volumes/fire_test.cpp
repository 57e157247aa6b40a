#include "volumes/fire.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"

namespace sfumato::volumes {
namespace {

using glm::dvec3;

DensityGrid oneVoxel(float value) {
  DensityGrid grid;
  grid.origin = glm::ivec3(-1);
  grid.size = glm::ivec3(3);
  grid.values.assign(27, 0.f);
  grid.values[13] = value;
  return grid;
}

Fire fireOf(float hottest, const FireLook& look) {
  return makeFire(oneVoxel(hottest), glm::dmat4(1.0), look, "a.vdb");
}

// The locus of black bodies for the 2 degree observer of 1931, as tables print it.
TEST(Fire, BlackBodiesHaveTheChromaticitiesOfThePlanckianLocus) {
  const double published[][3] = {{1000, 0.6528, 0.3444}, {1500, 0.5857, 0.3931}, {2000, 0.5267, 0.4133},
                                 {3000, 0.4369, 0.4041}, {6500, 0.3135, 0.3237}, {10000, 0.2807, 0.2884}};
  for (const auto& [kelvin, x, y] : published) {
    const dvec3 xyz = blackbodyXyz(kelvin);
    const double sum = xyz.x + xyz.y + xyz.z;
    // The observer's functions are rounded to four digits, and taken every 10 nm.
    EXPECT_NEAR(xyz.x / sum, x, 2e-4) << kelvin;
    EXPECT_NEAR(xyz.y / sum, y, 2e-4) << kelvin;
  }
}

TEST(Fire, BlackBodiesOf1500KHaveTheLuminanceOne) {
  EXPECT_NEAR(blackbodyXyz(1500).y, 1, 1e-12);
  // Light about 560 nm, by Wien's law.
  EXPECT_NEAR(std::log(blackbodyXyz(1600).y), 1.4388e7 / 575 * (1.0 / 1500 - 1.0 / 1600), 0.06);
  EXPECT_EQ(blackbodyXyz(0), dvec3(0));
  EXPECT_EQ(blackbodyXyz(-5), dvec3(0));
}

TEST(Fire, ColoursAreInTheGamutAndGrowWithTheHeat) {
  dvec3 before(0);
  // Colder ones glow less than the observer's four digits tell.
  for (double kelvin = 500; kelvin < 12000; kelvin += 50) {
    const dvec3 colour = blackbody(kelvin);
    for (int c = 0; c < 3; ++c) EXPECT_GE(colour[c], before[c]) << kelvin;
    before = colour;
  }
  EXPECT_EQ(blackbody(1850).b, 0);
  EXPECT_GT(blackbody(1950).b, 0);
  EXPECT_EQ(blackbody(930).g, 0);
  EXPECT_GT(blackbody(1000).g, 0);
  const dvec3 white = blackbody(6500);  // nearly that of sRGB
  EXPECT_NEAR(white.r / white.g, 1, 0.08);
  EXPECT_NEAR(white.b / white.g, 1, 0.08);
}

TEST(Fire, ARampFollowsTheBlackBody) {
  const Fire fire = fireOf(3.f, {.kelvin = 1000, .strength = 2});  // up to 3000 K
  for (double kelvin = 700; kelvin <= 3000; kelvin += 3.7) {
    const dvec3 expected = 2.0 * blackbody(kelvin);
    const dvec3 found = emissionOf(fire, kelvin / 1000);
    // Linear between steps of 3 K: (24000 / T^2 * 3)^2 / 8 of it.
    for (int c = 0; c < 2; ++c) EXPECT_NEAR(found[c], expected[c], 0.003 * expected[c] + 1e-6) << kelvin;
  }
  EXPECT_EQ(emissionOf(fire, 0), dvec3(0));
  EXPECT_EQ(emissionOf(fire, 5), emissionOf(fire, 3)) << "nothing is hotter than the grid";
}

TEST(Fire, FlamesGoThroughTheirColours) {
  const Fire fire = fireOf(7.f, {.ramp = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, .strength = 4});
  EXPECT_EQ(emissionOf(fire, 0.25), dvec3(2, 0, 0));
  EXPECT_EQ(emissionOf(fire, 0.75), dvec3(4, 2, 0));
  EXPECT_EQ(emissionOf(fire, 6), dvec3(4, 4, 0)) << "above 1 the last one holds";
}

TEST(Fire, IsRefusedWhereItIsTooHot) {
  try {
    fireOf(2.f, {.kelvin = 60000});
    FAIL();
  } catch (const base::Error& error) {
    EXPECT_STREQ(error.what(), "a.vdb: its fire has 1.2e+05 K, more than 100000: give fewer kelvin per unit");
    EXPECT_EQ(error.exitCode, base::ExitCode::Input);
  }
}

TEST(Fire, TheNameOfAGridSaysWhatItHolds) {
  EXPECT_EQ(usualLook("temperature").kelvin, 1.0);
  EXPECT_FALSE(usualLook("flame").kelvin);
  EXPECT_GE(usualLook("flame").ramp.size(), 2u);
}

}  // namespace
}  // namespace sfumato::volumes
