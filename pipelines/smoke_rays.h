// How far apart the camera's rays through smoke may be.
#pragma once

#include <span>

#include "pipelines/quality.h"
#include "shaders/shared/view.h"
#include "volumes/volumes_gpu.h"

namespace sfumato::pipelines {

// Pixels a side of the squares that one ray stands for: 4, 2, or 1 where every pixel has its own.
int smokeBlockSide(std::span<const volumes::MediumExtent> media, const shared::ViewParams& camera,
                   const Quality& quality);

}  // namespace sfumato::pipelines
