#include "pipelines/smoke_rays.h"

#include <algorithm>

namespace sfumato::pipelines {

namespace {

// Depth of a medium's farthest corner.
double farthestDepth(const volumes::MediumExtent& medium, const shared::ViewParams& camera) {
  double farthest = 0;
  for (int i = 0; i < 8; ++i) {
    const glm::dvec4 corner = medium.worldFromUnit * glm::dvec4(i & 1, i >> 1 & 1, i >> 2, 1);
    farthest = std::max(farthest, -(glm::dmat4(camera.viewFromWorld) * corner).z);
  }
  return farthest;
}

}  // namespace

int smokeBlockSide(std::span<const volumes::MediumExtent> media, const shared::ViewParams& camera,
                   const Quality& quality) {
  if (media.empty()) return 1;
  const bool orthographic = camera.halfExtent.z != 0;
  const double pixelAtOne = 2.0 * camera.halfExtent.y / camera.size.y;  // m
  double pixels = 1e30;                                                 // between rays
  for (const volumes::MediumExtent& medium : media) {
    const double pixel = pixelAtOne * (orthographic ? 1 : std::max(farthestDepth(medium, camera), 1e-30));
    pixels = std::min(pixels, quality.smokeRaySpacing * medium.voxel / pixel);
  }
  const int side = pixels >= 4 ? 4 : pixels >= 2 ? 2 : 1;
  return quality.halfResolutionSmoke ? std::max(side, 2) : side;
}

}  // namespace sfumato::pipelines
