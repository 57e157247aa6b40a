#include "scene/media.h"

#include <cmath>

#include "base/error.h"
#include "volumes/vdb_file.h"

namespace sfumato::scene {

std::vector<volumes::Medium> readMedia(const Scene& scene) {
  std::vector<volumes::Medium> media;
  for (const VolumePlacement& placement : scene.volumes) {
    volumes::Medium medium;
    medium.grid = volumes::readVdb(placement.file, placement.gridName);
    medium.worldFromIndex = placement.worldFromGridWorld * medium.grid.worldFromIndex;
    medium.scale = placement.scale;
    medium.extinctionColour = placement.extinctionColour;
    medium.albedo = placement.albedo;
    medium.g = placement.g;
    if (!std::isnormal(glm::determinant(glm::dmat3(medium.worldFromIndex))))
      base::fail(base::ExitCode::Input,
                 "{}: the volume is placed flat: give its node a scale that is not zero", placement.file);
    media.push_back(std::move(medium));
  }
  return media;
}

}  // namespace sfumato::scene
