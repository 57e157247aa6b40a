// Light that gas emits by itself: colours of black bodies, and the ramps that give a grid of temperatures or
// of flames its emission.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "volumes/grid.h"

namespace sfumato::volumes {

// How a grid glows; what glTF extras and flags say.
struct FireLook {
  std::optional<double> kelvin;  // per unit of the grid, above 0: it glows as black bodies do
  std::vector<glm::dvec3>
      ramp;             // else two colours or more, each >= 0, at equal steps of the grid's value from 0 to 1
  double strength = 1;  // what both are multiplied by, >= 0
};

// The one of a grid of which nothing is said but its name: "temperature" is in kelvin, others hold flames
// from 0 to 1.
FireLook usualLook(const std::string& gridName);

// Tristimulus values of a black body, by Planck's law and the CIE 1931 2 degree observer; Y is 1 at 1500 K. 0
// for 0 K and less.
glm::dvec3 blackbodyXyz(double kelvin);
// The same as linear sRGB. What is outside its gamut is cut to it: below about 1900 K there is no blue, below
// 960 K no green.
glm::dvec3 blackbody(double kelvin);

// Throws Input when the look is of black bodies and the grid gets hotter than 100,000 K; `place` begins the
// error. The ramp's colours are radiance that a metre of gas emits, so that with a strength of 1 a metre of
// gas of 1500 K has the luminance 1.
Fire makeFire(DensityGrid grid, const glm::dmat4& worldFromIndex, const FireLook& look,
              const std::string& place);

// Radiance that a metre of gas emits where the grid has a value.
glm::dvec3 emissionOf(const Fire& fire, double value);

}  // namespace sfumato::volumes
