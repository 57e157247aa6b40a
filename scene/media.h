// The volumes of a scene with their grids read.
#pragma once

#include <span>
#include <vector>

#include "scene/scene.h"
#include "volumes/grid.h"

namespace sfumato::scene {

// Reads the grid of every volume and places it. Throws what volumes::readVdb throws, and Input when a volume
// is placed flat (its transform has no inverse) or a fire is hotter than volumes::makeFire() takes.
std::vector<volumes::Medium> readMedia(const Scene& scene);

// Adds the point lights that the scene's fires ask for; `media` are those of readMedia().
void addFireLights(Scene& scene, std::span<const volumes::Medium> media);

}  // namespace sfumato::scene
