// The volumes of a scene with their grids read.
#pragma once

#include <vector>

#include "scene/scene.h"
#include "volumes/grid.h"

namespace sfumato::scene {

// Reads the grid of every volume and places it. Throws what volumes::readVdb throws, and Input when a volume
// is placed flat (its transform has no inverse).
std::vector<volumes::Medium> readMedia(const Scene& scene);

}  // namespace sfumato::scene
