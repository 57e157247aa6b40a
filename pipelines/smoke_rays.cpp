#include "pipelines/smoke_rays.h"

#include <algorithm>

#include "base/box.h"
#include "pipelines/image_bounds.h"

namespace sfumato::pipelines {

int smokeBlockSide(std::span<const volumes::MediumExtent> media, const scene::Camera& camera, int height,
                   const Quality& quality) {
  if (media.empty()) return 1;
  double pixels = 1e30;  // between rays
  for (const volumes::MediumExtent& medium : media) {
    const double depth = base::farthestDepth(camera.worldFromView, medium.worldFromUnit);
    pixels = std::min(pixels,
                      quality.smokeRaySpacing * medium.voxel * height * imageHeightsPerMetre(depth, camera));
  }
  const int side = pixels >= 4 ? 4 : pixels >= 2 ? 2 : 1;
  return quality.halfResolutionSmoke ? std::max(side, 2) : side;
}

}  // namespace sfumato::pipelines
