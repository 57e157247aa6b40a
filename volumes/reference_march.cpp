#include "volumes/reference_march.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "shaders/shared/volumes.h"
#include "volumes/fire.h"

namespace sfumato::volumes {

namespace {

// The line start + t * direction in a grid's index space, t as in world space.
struct IndexLine {
  glm::dvec3 start;
  glm::dvec3 direction;

  glm::dvec3 at(double t) const { return start + t * direction; }
};

IndexLine indexLine(const glm::dmat4& worldFromIndex, const glm::dvec3& pWorld, const glm::dvec3& direction) {
  const glm::dmat4 indexFromWorld = glm::inverse(worldFromIndex);
  return {glm::dvec3(indexFromWorld * glm::dvec4(pWorld, 1)),
          glm::dvec3(indexFromWorld * glm::dvec4(direction, 0))};
}

bool clipToBox(const DensityGrid& grid, const IndexLine& line, double& tMin, double& tMax) {
  for (int axis = 0; axis < 3; ++axis) {
    const double low = grid.origin[axis];
    const double high = low + grid.size[axis] - 1;
    const double start = line.start[axis];
    const double direction = line.direction[axis];
    if (!std::isfinite(start) || !std::isfinite(direction)) return false;  // a medium flattened to nothing
    if (direction == 0) {
      if (start < low || start > high) return false;
      continue;
    }
    const auto [enter, leave] = std::minmax({(low - start) / direction, (high - start) / direction});
    tMin = std::max(tMin, enter);
    tMax = std::min(tMax, leave);
  }
  return tMin <= tMax;
}

glm::dvec3 opticalDepth(const Medium& medium, const glm::dvec3& from, const glm::dvec3& to,
                        double stepVoxels) {
  const IndexLine line = indexLine(medium.worldFromIndex, from, to - from);
  double tMin = 0;
  double tMax = 1;
  if (!clipToBox(medium.grid, line, tMin, tMax)) return glm::dvec3(0);

  const double length = (tMax - tMin) * glm::distance(from, to);
  const auto steps = std::ceil(length / (stepVoxels * voxelSize(medium.worldFromIndex)));
  double sum = 0;
  for (double step = 0; step < steps; ++step)
    sum += densityAt(medium.grid, line.at(tMin + (tMax - tMin) * (step + 0.5) / steps));
  return steps > 0 ? sum * medium.scale * length / steps * medium.extinctionColour : glm::dvec3(0);
}

}  // namespace

double densityAt(const DensityGrid& grid, const glm::dvec3& pIndex) {
  const glm::dvec3 p = pIndex - glm::dvec3(grid.origin);
  const glm::ivec3 last = grid.size - 1;
  const bool inside =
      p.x >= 0 && p.y >= 0 && p.z >= 0 && p.x <= last.x && p.y <= last.y && p.z <= last.z;  // false for NaN
  if (!inside) return 0;

  const glm::ivec3 low(p);
  const glm::ivec3 high = glm::min(low + 1, last);
  const glm::dvec3 f = p - glm::dvec3(low);
  const auto alongX = [&](int y, int z) {
    return glm::mix(static_cast<double>(grid.value({low.x, y, z})),
                    static_cast<double>(grid.value({high.x, y, z})), f.x);
  };
  const auto alongXY = [&](int z) { return glm::mix(alongX(low.y, z), alongX(high.y, z), f.y); };
  return glm::mix(alongXY(low.z), alongXY(high.z), f.z);
}

glm::dvec3 extinctionAt(const Medium& medium, const glm::dvec3& pWorld) {
  const double density =
      densityAt(medium.grid, indexLine(medium.worldFromIndex, pWorld, glm::dvec3(0)).start);
  return medium.scale * density * medium.extinctionColour;
}

bool clipToMedium(const Medium& medium, const glm::dvec3& pWorld, const glm::dvec3& direction, double& tMin,
                  double& tMax) {
  return clipToBox(medium.grid, indexLine(medium.worldFromIndex, pWorld, direction), tMin, tMax);
}

bool clipToFire(const Fire& fire, const glm::dvec3& pWorld, const glm::dvec3& direction, double& tMin,
                double& tMax) {
  return clipToBox(fire.grid, indexLine(fire.worldFromIndex, pWorld, direction), tMin, tMax);
}

glm::dvec3 emissionAt(const Fire& fire, const glm::dvec3& pWorld) {
  return emissionOf(fire, densityAt(fire.grid, indexLine(fire.worldFromIndex, pWorld, glm::dvec3(0)).start));
}

glm::dvec3 opticalDepth(std::span<const Medium> media, const glm::dvec3& from, const glm::dvec3& to,
                        double stepVoxels) {
  glm::dvec3 sum(0);
  for (const Medium& medium : media) sum += opticalDepth(medium, from, to, stepVoxels);
  return sum;
}

double phaseHenyeyGreenstein(double cosine, double g) {
  const double base = 1 + g * g - 2 * g * cosine;
  return (1 - g * g) / (4 * std::numbers::pi * base * std::sqrt(base));
}

glm::dvec3 turnedLight(const Medium& medium, double cosine, const glm::dvec3& passing, int octaves) {
  const auto arriving = [&](int octave) {
    return glm::pow(passing, glm::dvec3(std::pow(OCTAVE_DEPTH, octave)));
  };
  glm::dvec3 sum = passing * phaseHenyeyGreenstein(cosine, medium.g);
  for (int i = 1; i <= octaves; ++i)
    sum += glm::pow(OCTAVE_KEPT * medium.albedo, glm::dvec3(i)) * (arriving(i) - arriving(i - 1)) *
           phaseHenyeyGreenstein(cosine, std::pow(OCTAVE_PHASE, i) * medium.g);
  return sum;
}

}  // namespace sfumato::volumes
