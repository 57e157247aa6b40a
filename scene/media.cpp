#include "scene/media.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/error.h"
#include "base/log.h"
#include "scene/fire_lights.h"
#include "volumes/fire.h"
#include "volumes/vdb_file.h"

namespace sfumato::scene {

namespace {

constexpr double leastVisible = 600;  // K

void checkExtent(const VolumePlacement& placement, const glm::dmat4& worldFromIndex) {
  if (!std::isnormal(glm::determinant(glm::dmat3(worldFromIndex))))
    base::fail(base::ExitCode::Input, "{}: the volume is placed flat: give its node a scale that is not zero",
               placement.file);
}

volumes::Fire readFire(const VolumePlacement& placement, const volumes::VdbReader& file) {
  volumes::DensityGrid grid = file.read(placement.fire.gridName, volumes::usualVdbBytes, "--fire");
  const glm::dmat4 worldFromIndex = placement.worldFromGridWorld * grid.worldFromIndex;
  checkExtent(placement, worldFromIndex);
  volumes::Fire fire =
      volumes::makeFire(std::move(grid), worldFromIndex, placement.fire.look, placement.file);
  if (placement.fire.look.kelvin && fire.top * *placement.fire.look.kelvin < leastVisible)
    base::warn(
        "{}: its fire has {:.4g} K at most, too little to be seen: say how many kelvin a unit of it has",
        placement.file, fire.top * *placement.fire.look.kelvin);
  return fire;
}

}  // namespace

std::vector<volumes::Medium> readMedia(const Scene& scene) {
  std::vector<volumes::Medium> media;
  for (const VolumePlacement& placement : scene.volumes) {
    volumes::Medium medium;
    const volumes::VdbReader file(placement.file);
    medium.grid = file.read(placement.gridName);
    medium.worldFromIndex = placement.worldFromGridWorld * medium.grid.worldFromIndex;
    medium.scale = placement.scale;
    medium.extinctionColour = placement.extinctionColour;
    medium.albedo = placement.albedo;
    medium.g = placement.g;
    checkExtent(placement, medium.worldFromIndex);
    if (!placement.fire.gridName.empty()) medium.fire = readFire(placement, file);
    media.push_back(std::move(medium));
  }
  return media;
}

void addFireLights(Scene& scene, std::span<const volumes::Medium> media) {
  for (size_t i = 0; i < media.size(); ++i)
    if (media[i].fire)
      std::ranges::move(fireLights(*media[i].fire, scene.volumes[i].fire.lights),
                        std::back_inserter(scene.lights));
}

}  // namespace sfumato::scene
