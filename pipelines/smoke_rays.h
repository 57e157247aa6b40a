// How far apart the camera's rays through smoke may be.
#pragma once

#include <span>

#include "pipelines/quality.h"
#include "scene/scene.h"
#include "volumes/volumes_gpu.h"

namespace sfumato::pipelines {

// Pixels a side of the squares that one ray stands for, in an image of so many pixels in height: 4, 2, or 1
// where every pixel has its own.
int smokeBlockSide(std::span<const volumes::MediumExtent> media, const scene::Camera& camera, int height,
                   const Quality& quality);

}  // namespace sfumato::pipelines
