#include "volumes/fire.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"

namespace sfumato::volumes {
namespace {

constexpr double brightnessIsOneAt = 1500;  // K
constexpr double hottest = 1e5;             // K
constexpr int blackbodySteps = 1023;

// CIE 1931 2 degree colour matching functions from 380 to 780 nm in steps of 10 nm (CIE 15).
constexpr double firstWavelength = 380;
constexpr double wavelengthStep = 10;
constexpr std::array<std::array<double, 3>, 41> observer = {{
    {0.0014, 0.0000, 0.0065}, {0.0042, 0.0001, 0.0201}, {0.0143, 0.0004, 0.0679}, {0.0435, 0.0012, 0.2074},
    {0.1344, 0.0040, 0.6456}, {0.2839, 0.0116, 1.3856}, {0.3483, 0.0230, 1.7471}, {0.3362, 0.0380, 1.7721},
    {0.2908, 0.0600, 1.6692}, {0.1954, 0.0910, 1.2876}, {0.0956, 0.1390, 0.8130}, {0.0320, 0.2080, 0.4652},
    {0.0049, 0.3230, 0.2720}, {0.0093, 0.5030, 0.1582}, {0.0633, 0.7100, 0.0782}, {0.1655, 0.8620, 0.0422},
    {0.2904, 0.9540, 0.0203}, {0.4334, 0.9950, 0.0087}, {0.5945, 0.9950, 0.0039}, {0.7621, 0.9520, 0.0021},
    {0.9163, 0.8700, 0.0017}, {1.0263, 0.7570, 0.0011}, {1.0622, 0.6310, 0.0008}, {1.0026, 0.5030, 0.0003},
    {0.8544, 0.3810, 0.0002}, {0.6424, 0.2650, 0.0000}, {0.4479, 0.1750, 0.0000}, {0.2835, 0.1070, 0.0000},
    {0.1649, 0.0610, 0.0000}, {0.0874, 0.0320, 0.0000}, {0.0468, 0.0170, 0.0000}, {0.0227, 0.0082, 0.0000},
    {0.0114, 0.0041, 0.0000}, {0.0058, 0.0021, 0.0000}, {0.0029, 0.0010, 0.0000}, {0.0014, 0.0005, 0.0000},
    {0.0007, 0.0002, 0.0000}, {0.0003, 0.0001, 0.0000}, {0.0002, 0.0001, 0.0000}, {0.0001, 0.0000, 0.0000},
    {0.0000, 0.0000, 0.0000},
}};

// Planck's law up to a factor.
double spectralRadiance(double nanometres, double kelvin) {
  constexpr double secondConstant = 1.438776877e7;  // h c / k, nm K
  return std::pow(nanometres, -5) / std::expm1(secondConstant / (nanometres * kelvin));
}

glm::dvec3 unscaledXyz(double kelvin) {
  glm::dvec3 sum(0);
  for (size_t i = 0; i < observer.size(); ++i)
    sum += spectralRadiance(firstWavelength + wavelengthStep * static_cast<double>(i), kelvin) *
           glm::dvec3(observer[i][0], observer[i][1], observer[i][2]);
  return sum;
}

float largestValue(const DensityGrid& grid) {
  float largest = 0;
  forEachRow(grid, [&](const glm::ivec3&, std::span<const float> values) {
    largest = std::max(largest, *std::max_element(values.begin(), values.end()));
  });
  return largest;
}

}  // namespace

FireLook usualLook(const std::string& gridName) {
  if (gridName == "temperature") return {.kelvin = 1.0};
  return {.ramp = {{0, 0, 0}, {0.3, 0.02, 0}, {1, 0.22, 0.02}, {1.6, 0.75, 0.15}, {2, 1.6, 0.9}}};
}

glm::dvec3 blackbodyXyz(double kelvin) {
  static const double one = unscaledXyz(brightnessIsOneAt).y;
  return kelvin > 0 ? unscaledXyz(kelvin) / one : glm::dvec3(0);
}

glm::dvec3 blackbody(double kelvin) {
  const glm::dmat3 srgbFromXyz(3.2404542, -0.9692660, 0.0556434, -1.5371385, 1.8760108, -0.2040259,
                               -0.4985314, 0.0415560, 1.0572252);
  return glm::max(srgbFromXyz * blackbodyXyz(kelvin), glm::dvec3(0));
}

Fire makeFire(DensityGrid grid, const glm::dmat4& worldFromIndex, const FireLook& look,
              const std::string& place) {
  Fire fire{.worldFromIndex = worldFromIndex};
  if (look.kelvin) {
    fire.top = largestValue(grid);
    const double kelvin = fire.top * *look.kelvin;
    if (!(kelvin <= hottest))
      base::fail(base::ExitCode::Input,
                 "{}: its fire has {:.4g} K, more than {:.0f}: give fewer kelvin per unit", place, kelvin,
                 hottest);
    for (int i = 0; i <= blackbodySteps; ++i)
      fire.ramp.emplace_back(look.strength * blackbody(kelvin * i / blackbodySteps));
  } else {
    for (const glm::dvec3& colour : look.ramp) fire.ramp.emplace_back(look.strength * colour);
  }
  fire.grid = std::move(grid);
  return fire;
}

glm::dvec3 emissionOf(const Fire& fire, double value) {
  const auto last = static_cast<double>(fire.ramp.size() - 1);
  const double place = std::clamp(value / fire.top, 0.0, 1.0) * last;
  const double low = std::min(std::floor(place), last - 1);
  const auto entry = static_cast<size_t>(low);
  return glm::mix(glm::dvec3(fire.ramp[entry]), glm::dvec3(fire.ramp[entry + 1]), place - low);
}

}  // namespace sfumato::volumes
