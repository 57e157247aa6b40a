#include "pipelines/ambient_occlusion.h"

#include <algorithm>
#include <cstddef>

#include "scene/visible_hull.h"

namespace sfumato::pipelines {

int pixelsAside(OcclusionSize size) {
  switch (size) {
    case OcclusionSize::Half:
      return 2;
    case OcclusionSize::Quarter:
      return 4;
    default:
      return 1;
  }
}

int blurReach(OcclusionSize size) {
  return size == OcclusionSize::Quarter ? 10 : 30;
}

const base::Choice<OcclusionSize>& occlusionSizes() {
  static const base::Choice<OcclusionSize> choice{"--ssao", {"off", "full", "half", "quarter"}};
  return choice;
}

double usualOcclusionRadius(const scene::Scene& scene) {
  std::vector<double> diagonals;
  for (const glm::dmat4& worldFromUnit : scene::boundingBoxes(scene))
    diagonals.push_back(glm::length(glm::dvec3(worldFromUnit * glm::dvec4(1, 1, 1, 0))));
  if (diagonals.empty()) return 1;
  const auto middle = diagonals.begin() + static_cast<std::ptrdiff_t>(diagonals.size() / 2);
  std::nth_element(diagonals.begin(), middle, diagonals.end());
  return *middle > 0 ? 0.1 * *middle : 1;
}

}  // namespace sfumato::pipelines
