// What a medium does to light, in double precision on the CPU: the oracle for the GPU's marches.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "volumes/grid.h"

namespace sfumato::volumes {

// Density at an index position: trilinear, 0 outside the grid's box.
double densityAt(const DensityGrid& grid, const glm::dvec3& pIndex);

// Extinction sigma_t at a world point, 1/m, per channel.
glm::dvec3 extinctionAt(const Medium& medium, const glm::dvec3& pWorld);

// Where the ray p + t * direction, t in [tMin, tMax], is inside the medium's box. False when nowhere.
bool clipToMedium(const Medium& medium, const glm::dvec3& pWorld, const glm::dvec3& direction, double& tMin,
                  double& tMax);
bool clipToFire(const Fire& fire, const glm::dvec3& pWorld, const glm::dvec3& direction, double& tMin,
                double& tMax);

// Emission of a fire at a world point: radiance per metre.
glm::dvec3 emissionAt(const Fire& fire, const glm::dvec3& pWorld);

// Optical depth of the media between two world points per channel, in steps of at most `stepVoxels` voxels of
// each (midpoint rule).
glm::dvec3 opticalDepth(std::span<const Medium> media, const glm::dvec3& from, const glm::dvec3& to,
                        double stepVoxels);

// Henyey-Greenstein phase function, 1/sr; cosine of the angle between the directions of travel before and
// after.
double phaseHenyeyGreenstein(double cosine, double g);

// What a medium turns by an angle of light of which `passing` gets straight to a point, over the share of it
// that scatters, 1/sr: once, and in `octaves` of multiple scattering (docs/how_it_works.md, "The medium").
glm::dvec3 turnedLight(const Medium& medium, double cosine, const glm::dvec3& passing, int octaves);

}  // namespace sfumato::volumes
