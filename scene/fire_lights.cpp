#include "scene/fire_lights.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "volumes/fire.h"

namespace sfumato::scene {
namespace {

struct Spark {
  glm::dvec3 position;   // world
  glm::dvec3 intensity;  // W/sr
};

double luminance(const glm::dvec3& rgb) {
  return glm::dot(rgb, glm::dvec3(0.2126, 0.7152, 0.0722));
}

// The voxels that emit anything.
std::vector<Spark> sparksOf(const volumes::Fire& fire) {
  const double voxelVolume = std::abs(glm::determinant(glm::dmat3(fire.worldFromIndex)));
  std::vector<Spark> sparks;
  volumes::forEachRow(fire.grid, [&](const glm::ivec3& first, std::span<const float> values) {
    for (size_t i = 0; i < values.size(); ++i) {
      const glm::dvec3 intensity = voxelVolume * volumes::emissionOf(fire, values[i]);
      if (luminance(intensity) <= 0) continue;
      const glm::dvec3 pIndex =
          glm::dvec3(fire.grid.origin + first) + glm::dvec3(static_cast<double>(i), 0, 0);
      sparks.push_back({glm::dvec3(fire.worldFromIndex * glm::dvec4(pIndex, 1)), intensity});
    }
  });
  return sparks;
}

// Some of the sparks, and what they are together.
struct Part {
  std::span<Spark> sparks;
  glm::dvec3 intensity{0};
  double power = 0;  // luminance of it
  glm::dvec3 middle{0};
  int axis = 0;      // the longest one
  double worth = 0;  // of being cut

  explicit Part(std::span<Spark> all) : sparks(all) {
    glm::dvec3 squares(0);
    for (const Spark& spark : sparks) {
      const double weight = luminance(spark.intensity);
      intensity += spark.intensity;
      power += weight;
      middle += weight * spark.position;
    }
    middle /= power;
    for (const Spark& spark : sparks)
      squares += luminance(spark.intensity) * (spark.position - middle) * (spark.position - middle);
    for (int i = 1; i < 3; ++i)
      if (squares[i] > squares[axis]) axis = i;
    worth = squares[axis];
  }

  // At the median of its power. Neither half is empty.
  std::pair<Part, Part> halves() const {
    std::ranges::sort(sparks, [&](const Spark& a, const Spark& b) {
      for (int i = 0; i < 3; ++i) {
        const int k = (axis + i) % 3;
        if (a.position[k] != b.position[k]) return a.position[k] < b.position[k];
      }
      return false;
    });
    double before = 0;
    size_t cut = 0;
    while (cut + 1 < sparks.size() && before < power / 2) before += luminance(sparks[cut++].intensity);
    return {Part(sparks.first(cut)), Part(sparks.subspan(cut))};
  }
};

}  // namespace

std::vector<lights::Light> fireLights(const volumes::Fire& fire, int count) {
  std::vector<Spark> sparks = sparksOf(fire);
  if (sparks.empty() || count <= 0) return {};
  std::vector<Part> parts = {Part(sparks)};
  while (parts.size() < static_cast<size_t>(count)) {
    const auto widest = std::ranges::max_element(parts, {}, &Part::worth);
    if (widest->sparks.size() < 2 || widest->worth <= 0) break;
    auto [low, high] = widest->halves();
    *widest = low;
    parts.push_back(high);
  }
  std::vector<lights::Light> found;
  for (const Part& part : parts) {
    lights::Light light;
    light.name = fmt::format("fire {}", found.size());
    light.position = part.middle;
    light.intensity = part.intensity;
    found.push_back(light);
  }
  return found;
}

}  // namespace sfumato::scene
