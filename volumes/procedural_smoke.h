// Smoke made from noise, so that demos and tests need no download.
#pragma once

#include <cstdint>

#include "volumes/grid.h"

namespace sfumato::volumes {

// A rising plume, about 1 m wide and `height` metres high, its foot at the origin, density in [0, 1]: a
// wandering column of puffs, displaced by divergence-free curl noise (Bridson, Hourihan, Nordenstam 2007) and
// eroded by fractal noise into billows, wisps and hollows. `voxelsHigh` in [8, 512] sets the resolution,
// `height` is in [1, 20]; the same seed gives the same bits, whatever the number of threads.
DensityGrid makePlume(int voxelsHigh, double height, uint64_t seed);

// A fire on the origin, `height` metres high and about half as wide, and the smoke above it: tongues of flame
// of up to 2000 K, torn by the same noise. Both grids have one transform. Arguments as for makePlume().
struct FlameGrids {
  DensityGrid smoke;        // "density", in [0, 1]
  DensityGrid temperature;  // "temperature", K; 0 around the fire
};
FlameGrids makeFlame(int voxelsHigh, double height, uint64_t seed);

}  // namespace sfumato::volumes
